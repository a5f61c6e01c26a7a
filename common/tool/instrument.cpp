#include "common/tool/instrument.hpp"

namespace palpate {

std::vector<ToolPart> sample_tool(double tip_radius, double shaft_radius, double shaft_length) {
  std::vector<ToolPart> samples{{.radius = tip_radius}};
  const double step = 1.5 * shaft_radius;
  for (int i = 0; i < max_shaft_samples; ++i) {
    const double behind = tip_radius + i * step;
    if (behind > shaft_length) break;
    ToolPart& sphere = samples.emplace_back(ToolPart{.radius = shaft_radius});
    sphere.pose.translation().z() = -behind;
  }
  return samples;
}

std::optional<ForcepsShape> forceps_shape(const Tool& tool) {
  if (tool.kind != "forceps" || !tool.jaws) return std::nullopt;
  return ForcepsShape{tool.shaft_radius, tool.shaft_length, tool.jaws->length, tool.jaws->radius};
}

std::vector<ToolPart> tool_parts(const Tool& tool, double opening) {
  const auto shape = forceps_shape(tool);
  if (!shape) return sample_tool(tool.radius, tool.shaft_radius, tool.shaft_length);
  const auto parts = forceps_parts(*shape, opening);
  return {parts.begin(), parts.end()};
}

}  // namespace palpate
