#pragma once
#include <vector>

#include "common/contact/body_part.hpp"
#include "common/contact/step_settings.hpp"
#include "common/models/moving/local_body.hpp"

namespace palpate {

/// Moving tissue in the haptic step: what each tool feels of it, by the newest local contact model that the deformation
/// node sent for that tool.
class LocalPart : public BodyPart {
 public:
  explicit LocalPart(const StepSettings& settings);

  const LocalBody& of(int tool) const { return of_tool_[tool]; }
  LocalBody& of(int tool) { return of_tool_[tool]; }

  LawOutcome touch(const ToolsInStep& in, std::span<ToolLoad> loads) override;
  // The jaws' hold itself is the deformation node's: it hears of it from the tool's state.
  BetweenJaws between(const OpenJaws& jaws) override { return of_tool_[jaws.tool].between(jaws); }
  double grasp_load(int tool) const override { return of_tool_[tool].grasp_load(); }
  void state(State& s, std::span<const MovingTool> tools) override;

 private:
  std::vector<LocalBody> of_tool_;
};

}  // namespace palpate
