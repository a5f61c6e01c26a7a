#pragma once
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "common/archive/compliance.hpp"
#include "common/contact/step_settings.hpp"
#include "common/contact/tool_contacts.hpp"
#include "common/tool/forceps.hpp"

namespace palpate {

/// What one body does to one tool in a step. Linear and corrected forces share their direction of press.
struct ToolLoad {
  Eigen::Vector3d press = Eigen::Vector3d::Zero();   ///< unit or zero: common direction of the press on the tissue
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N] on the tool, after the non-linear correction
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m] on the tool about its tip, likewise
};

/// One body under the hand whose contacts this node solves: a compliance among its surface nodes, the surface and the
/// contacts. What moves the surface is the derived class's.
class TouchBody {
 public:
  static constexpr int max_contacts = 96;

  virtual ~TouchBody() = default;

  /// Brings the surface up to date, near the tools at least.
  virtual void update_surface(std::span<const MovingTool> tools) = 0;
  /// collide: finds what the tools touch.
  void collide(std::span<const MovingTool> tools) { contacts_.collide(tools); }
  /// hold: prescribes the contacts' displacements and solves for their forces.
  virtual LawOutcome hold(std::span<const MovingTool> tools);
  /// force: sums what acts on each tool (one entry per tool).
  virtual void load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const;

  const TouchSurface& surface() const { return contacts_.surface(); }
  const ContactLaw& law() const { return law_; }
  /// Takes up a contact that a peer kept for this tool.
  void adopt(const TouchContact& contact) { contacts_.adopt(contact); }
  /// Jaws of a probe that close hold the nodes between them as displacement constraints until let_go().
  void grasp(int tool, const Eigen::Isometry3d& pose, const ProbeJaws& jaws) {
    contacts_.grasp(tool, pose, jaws.length, jaws.width, [](int) { return true; });
  }
  /// The same for a forceps' jaws at this opening [rad]; true if there is something between them.
  bool grasp(int tool, const Eigen::Isometry3d& pose, const ForcepsShape& shape, double opening);
  void let_go(int tool) { contacts_.let_go(tool); }
  double grasp_load(int tool) const;  ///< [N] size of the sum of the forces by which the tool's jaws hold the body
  /// [m] by which tissue reaches out from its surface nodes: half the thickness of a wall.
  virtual double wall_radius() const { return 0; }
  void forget_factor() { law_.forget_factor(); }
  /// Depth [m] to which a part of a tool reaches into the rest shape; 0 if it does not touch it.
  virtual double penetration(const Segment& axis, double radius) const;

  virtual std::size_t state_size() const { return contacts_.state_size(); }
  virtual void save(unsigned char* to) const { contacts_.save(to); }
  /// Throws std::runtime_error on a state that does not fit this body and these tools.
  virtual void restore(const unsigned char* from, std::span<const MovingTool> tools) { contacts_.restore(from, tools); }

 protected:
  TouchBody(const SurfaceMap& map, Compliance<double> compliance, const StepSettings& settings,
            ToolContacts::Options options = {});

  const SurfaceMap& map() const { return map_; }
  const Compliance<double>& compliance() const { return compliance_; }
  ToolContacts& contacts() { return contacts_; }
  /// Where the contact law takes a node to be without contact forces: displacement [m] from rest.
  void move_rest(int node, const Eigen::Vector3d& displacement) {
    unloaded_[node] = map_.position[node] + displacement;
  }
  Eigen::Vector3d press_of(int tool) const;

 private:
  const SurfaceMap map_;
  const Compliance<double> compliance_;
  std::vector<Eigen::Vector3d> unloaded_;  ///< [m] per node
  ContactLaw law_;
  ToolContacts contacts_;
};

}  // namespace palpate
