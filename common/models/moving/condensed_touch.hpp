#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/contact/step_settings.hpp"
#include "common/contact/tool_contacts.hpp"
#include "common/describe/state.hpp"
#include "common/dynamics/condensed_part.hpp"

namespace palpate {

/// The quasi-static part of a hybrid organ and the tools that touch it.
class CondensedTouch {
 public:
  /// `archive`: read with ArchivePart::surface. Couples the part to the model, which must outlive this object.
  CondensedTouch(const Archive& archive, const StepSettings& settings, bool single, DynamicModel& model);

  /// Once a tick: brings the surface near the tools up to date and finds what they touch.
  void find(std::span<const MovingTool> tools);
  /// Jaws take nodes of this part alone; those that it shares are the moving tissue's.
  ToolContacts& search() { return contacts_; }
  void let_go(int tool) { contacts_.let_go(tool); }
  bool grasping(int tool) const;
  void drop_tool(int tool);

  /// Before a step of the tissue: holds the contacts, with the tools as they are at the step's end.
  void hold(std::span<const MovingTool> tools);
  /// After it.
  void take() { part_.take(model_); }
  /// After the last step of a tick.
  void end_tick(std::span<const MovingTool> tools) { contacts_.settle(tools); }

  CondensedPart& part() { return part_; }
  const CondensedPart& part() const { return part_; }
  const TouchSurface& surface() const { return surface_; }
  std::span<const TouchContact> contacts() const { return part_.law().contacts(); }
  Eigen::Vector3d force(int contact) const { return part_.contact_force(contact); }  ///< [N] on the tissue

  /// Overwrites the positions [m] of this part's visible nodes, from `origin` on.
  void shape(std::span<const Eigen::Vector3d> rest, const Eigen::Vector3d& origin, std::span<Eigen::Vector3f> position);

  /// What is held is factorised anew in the next step, so that a restored state goes on alike.
  void forget_factor() { part_.law().forget_factor(); }
  void state(State& s, std::span<const MovingTool> tools = {});

 private:
  DynamicModel& model_;
  SurfaceMap map_;  ///< with the triangles of this part alone
  CondensedPart part_;
  TouchSurface surface_;
  ToolContacts contacts_;
  std::vector<double> displacement_;
  std::vector<Eigen::Vector3f> moved_;
};

}  // namespace palpate
