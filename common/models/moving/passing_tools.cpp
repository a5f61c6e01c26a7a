#include "common/models/moving/passing_tools.hpp"

#include <algorithm>

#include "common/geometry/segment.hpp"

namespace palpate {
namespace {

constexpr double kMeeting = 1e-9;    // [m] within which a line meets a facet
constexpr double kWithdrawn = 0.01;  // [m] of free air about a tool that passed, after which it is felt again

}  // namespace

void PassingTools::meet(std::span<const ToolInTick> tools, bool cut, const std::function<ToolDeed(int tool)>& deed) {
  for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
    if (!tools[t].begins) continue;
    const auto [holds, glows] = deed(t);
    passing_[t] = !holds && (glows || (cut ? is_near(tools[t].moving) : runs_through(tools[t].moving)));
  }
}

void PassingTools::clear(std::span<const ToolInTick> tools, const std::function<ToolDeed(int tool)>& deed) {
  for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
    if (!passing_[t]) continue;
    const auto [holds, glows] = deed(t);
    passing_[t] = tools[t].present && !holds && (glows || is_near(tools[t].moving));
  }
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

bool PassingTools::is_near(const MovingTool& tool) const {
  for (int p = 0; p < tool.size(); ++p) {
    const Segment axis = tool.axis(p);
    const double reach = tool.radius(p) + kWithdrawn;
    for (const int facet : surface_.find(axis.start, axis.end, reach))
      if (closest_points(axis, surface_.corners(facet)).squared_distance < reach * reach) return true;
  }
  return false;
}

}  // namespace palpate
