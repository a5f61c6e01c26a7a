#pragma once
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "common/archive/compliance.hpp"
#include "common/contact/body_part.hpp"
#include "common/contact/jaw_obstacles.hpp"
#include "common/contact/step_settings.hpp"
#include "common/contact/tool_contacts.hpp"
#include "common/tool/forceps.hpp"

namespace palpate {

/// One body under the hand whose contacts this node solves: a compliance among its surface nodes, the surface and the
/// contacts. What moves the surface is the derived class's.
class TouchBody : public BodyPart {
 public:
  static constexpr int kMaxContacts = 96;

  /// collide: finds what the tools touch.
  void collide(std::span<const MovingTool> tools) { contacts_.collide(tools); }
  /// hold: prescribes the contacts' displacements and solves for their forces.
  virtual LawOutcome hold(std::span<const MovingTool> tools);
  /// collide, hold and load in turn.
  LawOutcome touch(const ToolsInStep& in, std::span<ToolLoad> loads) override;
  /// force: sums what acts on each tool (one entry per tool).
  virtual void load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const;

  const TouchSurface& surface() const { return surface_; }
  const ContactLaw& law() const { return law_; }
  const ContactLaw* held() const override { return &law_; }
  void for_each_contact(const VisitContact& visit) const override;
  void for_each_force(const VisitForce& visit) const override;
  Capacity capacity() const override { return {kMaxContacts, 3 * kMaxContacts}; }
  bool fits(const MovingTool& tool, std::span<const TouchContact> contacts) const override;
  void adopt(std::span<const TouchContact> contacts) override;
  void pinch(int tool, const Eigen::Isometry3d& pose, const ClosingJaws& jaws) override {
    contacts_.grasp(tool, pose, jaws.length, jaws.width, [](int) { return true; });
  }
  BetweenJaws between(const OpenJaws& jaws) override;
  void grasp(const OpenJaws& jaws) override;
  void let_go(int tool) override { contacts_.let_go(tool); }
  double grasp_load(int tool) const override;
  /// [m] by which tissue reaches out from its surface nodes: half the thickness of a wall.
  virtual double wall_radius() const { return 0; }
  void forget_factor() override { law_.forget_factor(); }
  double penetration(const Segment& axis, double radius) const override;
  /// Restoring throws std::runtime_error on a state that does not fit this body and these tools.
  void state(State& s, std::span<const MovingTool> tools) override {
    if (by_mesh()) surface_.state(s);
    contacts_.state(s, tools);
  }

 protected:
  TouchBody(const SurfaceMap& map, Compliance<double> compliance, const StepSettings& settings,
            ToolContacts::Options options = {});

  const SurfaceMap& map() const { return map_; }
  /// Whether a tool may touch it by the mesh. If none may, nothing asks where its surface is, and that stays at rest.
  virtual bool by_mesh() const { return true; }
  const Compliance<double>& compliance() const { return compliance_; }
  ToolContacts& contacts() { return contacts_; }
  /// Marks the nodes that are near the tools or carry a contact; the derived class then works out where they are.
  std::span<const int> mark(std::span<const MovingTool> tools) {
    return palpate::mark(surface_, contacts_, law_, tools);
  }
  /// Marks all other nodes too, after mark(): of a body that moves as a whole.
  std::span<const int> mark_all() {
    surface_.mark_all();
    return surface_.marked();
  }
  /// Moves the marked nodes: three entries [m] per node.
  void move_marked(std::span<const double> displacement) { surface_.move_marked(displacement); }
  /// Where the contact law takes a node to be without contact forces: displacement [m] from rest.
  void move_rest(int node, const Eigen::Vector3d& displacement) {
    unloaded_[node] = map_.position[node] + displacement;
  }
  virtual Eigen::Vector3d press_of(int tool) const;
  /// Takes so many steps under tools that stand.
  void stand(std::span<const MovingTool> tools, int steps);

 private:
  bool has(const Anchor& anchor) const;
  double deepest(const MovingTool& tool, std::span<const TouchContact> contacts) const;

  const SurfaceMap map_;
  const Compliance<double> compliance_;
  std::vector<Eigen::Vector3d> unloaded_;  ///< [m] per node
  const CompliantResponse response_;
  TouchSurface surface_;
  ContactLaw law_;
  ToolContacts contacts_;
  std::vector<ToolLoad> own_;  ///< what this body does to each tool
  JawObstacles obstacles_;
};

}  // namespace palpate
