#include "common/tool/instrument.hpp"

namespace palpate {

std::vector<ToolPart> sample_tool(double tip_radius, double shaft_radius, double shaft_length) {
  std::vector<ToolPart> samples{{.radius = tip_radius}};
  const double step = 1.5 * shaft_radius;
  for (int i = 0; i < kMaxShaftSamples; ++i) {
    const double behind = tip_radius + i * step;
    if (behind > shaft_length) break;
    ToolPart& sphere = samples.emplace_back(ToolPart{.radius = shaft_radius});
    sphere.pose.translation().z() = -behind;
  }
  return samples;
}

std::optional<ForcepsShape> forceps_shape(const Tool& tool) {
  const ForcepsSpec* forceps = tool.forceps();
  if (!forceps) return std::nullopt;
  return ForcepsShape{tool.shaft_radius, tool.shaft_length, forceps->jaws.length, forceps->jaws.radius};
}

JawParts jaw_parts(const Tool& tool) {
  if (tool.probe()) return {0, 1};
  return {forceps_jaw_a, kForcepsPartCount};
}

std::vector<ToolPart> tool_parts(const Tool& tool, double opening) {
  if (const ProbeSpec* probe = tool.probe()) return sample_tool(probe->radius, tool.shaft_radius, tool.shaft_length);
  const auto parts = forceps_parts(*forceps_shape(tool), opening);
  return {parts.begin(), parts.end()};
}

}  // namespace palpate
