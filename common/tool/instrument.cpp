#include "common/tool/instrument.hpp"

namespace palpate {

std::vector<ToolPart> probe_parts(double tip_radius, double shaft_radius, double shaft_length) {
  std::vector<ToolPart> parts{{.radius = tip_radius}};
  if (shaft_length <= tip_radius) return parts;
  ToolPart& shaft = parts.emplace_back(ToolPart{.length = shaft_length - tip_radius, .radius = shaft_radius});
  shaft.pose.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  shaft.pose.translation().z() = -tip_radius;
  return parts;
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
