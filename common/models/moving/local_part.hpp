#pragma once
#include <vector>

#include "common/contact/body_part.hpp"
#include "common/contact/step_settings.hpp"
#include "common/models/moving/local_body.hpp"

namespace palpate {

/// Moving tissue in the haptic step: what each tool feels of it, by the newest local contact model that the deformation
/// node sent for that tool, within what the motion of the tools explains: a tool gets no more force than if all tools
/// together had pressed the stiffest tissue near it as far as they have moved, and all that moves lay on it.
class LocalPart : public BodyPart {
 public:
  static constexpr double kSlack = 2e-4;  ///< [m] that tissue may have moved by itself

  /// `limits` outlives this object.
  LocalPart(const StepSettings& settings, const TissueLimits& limits);

  const LocalBody& of(int tool) const { return of_tool_[tool]; }
  LocalBody& of(int tool) { return of_tool_[tool]; }

  LawOutcome touch(const ToolsInStep& in, std::span<ToolLoad> loads) override;
  // The jaws' hold itself is the deformation node's: it hears of it from the tool's state.
  BetweenJaws between(const OpenJaws& jaws) override { return of_tool_[jaws.tool].between(jaws); }
  double grasp_load(int tool) const override { return of_tool_[tool].grasp_load(); }
  void state(State& s, std::span<const MovingTool> tools) override;

 private:
  double moved(const ToolsInStep& in);

  const TissueLimits& limits_;
  std::vector<LocalBody> of_tool_;
  std::vector<double> pressing_;  ///< [N/m] of a half-space against a punch of the tool's radius R: 2 E* R
};

}  // namespace palpate
