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

EndAbilities abilities_of(const Tool& tool) {
  return std::visit([](const auto& end) { return abilities(end); }, tool.end);
}

std::optional<ForcepsShape> forceps_shape(const Tool& tool) {
  const EndAbilities can = abilities_of(tool);
  if (!can.turning) return std::nullopt;
  return ForcepsShape{tool.shaft_radius, tool.shaft_length, can.turning->length, can.turning->radius};
}

std::vector<ToolPart> tool_parts(const Tool& tool, double opening) {
  return std::visit([&](const auto& end) { return end_parts(end, tool, opening); }, tool.end);
}

}  // namespace palpate
