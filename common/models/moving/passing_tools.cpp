#include "common/models/moving/passing_tools.hpp"

#include <algorithm>

#include "common/geometry/segment.hpp"

namespace palpate {
namespace {

constexpr double kMeeting = 1e-9;  // [m] within which a line meets a facet

}  // namespace

void PassingTools::meet(std::span<const ToolInTick> tools, bool cut, const std::function<bool(int tool)>& holds) {
  for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
    const MovingTool& tool = tools[t].moving;
    if (tools[t].begins) passing_[t] = !holds(t) && (cut ? touches(tool) : runs_through(tool));
  }
}

void PassingTools::clear(std::span<const ToolInTick> tools, const std::function<bool(int tool)>& holds) {
  for (int t = 0; t < static_cast<int>(tools.size()); ++t)
    passing_[t] = passing_[t] && tools[t].present && !holds(t) && touches(tools[t].moving);
}

// The line from a tool's tip along its parts meets the surface.
bool PassingTools::runs_through(const MovingTool& tool) const {
  const auto meets = [&](const Segment& line) {
    return std::ranges::any_of(surface_.find(line.start, line.end, kMeeting), [&](int facet) {
      return closest_points(line, surface_.corners(facet)).squared_distance < kMeeting * kMeeting;
    });
  };
  for (int p = 0; p < tool.size(); ++p) {
    const Segment axis = tool.axis(p);
    if (meets({tool.now.translation(), axis.start}) || meets(axis)) return true;
  }
  return false;
}

bool PassingTools::touches(const MovingTool& tool) const {
  for (int p = 0; p < tool.size(); ++p) {
    const Segment axis = tool.axis(p);
    const double radius = tool.radius(p);
    for (const int facet : surface_.find(axis.start, axis.end, radius))
      if (closest_points(axis, surface_.corners(facet)).squared_distance < radius * radius) return true;
  }
  return false;
}

}  // namespace palpate
