#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "common/contact/tool_contacts.hpp"
#include "common/models/nonlinear.hpp"
#include "common/scene/scene.hpp"
#include "common/tensors/compliance.hpp"

namespace palpate {

/// What one body does to one tool in a step. Linear and corrected forces share their direction of press.
struct ToolLoad {
  Eigen::Vector3d press = Eigen::Vector3d::Zero();   ///< unit or zero: common direction of the press on the tissue
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N] on the tool, after the non-linear correction
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m] on the tool about its tip, likewise
};

/// One quasi-static body under the hand: its tensors, the surface near the tools and the contacts.
class TouchBody {
 public:
  static constexpr int max_contacts = 96;

  TouchBody(const Archive& archive, const Scene& scene, int body);

  /// collide: brings the surface near the tools up to date and finds what they touch.
  void collide(std::span<const MovingTool> tools);
  /// hold: prescribes the contacts' displacements and solves for their forces.
  LawOutcome hold(std::span<const MovingTool> tools);
  /// force: sums what acts on each tool (one entry per tool).
  void load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const;

  const TouchSurface& surface() const { return contacts_.surface(); }
  const ContactLaw& law() const { return law_; }
  /// Takes up a contact that a peer kept for this tool.
  void adopt(const TouchContact& contact) { law_.add(contact, std::span(contact.force.data(), 3)); }
  /// Jaws that close hold the nodes between them as displacement constraints until let_go().
  void grasp(int tool, const Eigen::Isometry3d& pose, const Jaws& jaws) {
    contacts_.grasp(tool, pose, jaws.length, jaws.width, [](int) { return true; });
  }
  void let_go(int tool) { contacts_.let_go(tool); }
  void forget_factor() { law_.forget_factor(); }
  /// Depth [m] to which a sphere reaches into the rest shape; 0 if it does not touch it.
  double penetration(const Eigen::Vector3d& centre, double radius) const;

  std::size_t state_size() const { return contacts_.state_size(); }
  void save(unsigned char* to) const { contacts_.save(to); }
  /// Throws std::runtime_error on a state that does not fit this body and these tools.
  void restore(const unsigned char* from, std::span<const MovingTool> tools) { contacts_.restore(from, tools); }

 private:
  void update_surface(std::span<const MovingTool> tools);
  void superpose(int tool, std::vector<double>& displacement);
  Eigen::Vector3d press_of(int tool) const;

  const SurfaceMap map_;
  Compliance<double> compliance_;
  ContactLaw law_;
  ToolContacts contacts_;
  std::optional<QuasiNonlinear> nonlinear_;
  std::vector<const double*> columns_;
  std::vector<double> coefficients_, displacement_, of_tool_, whole_;
};

}  // namespace palpate
