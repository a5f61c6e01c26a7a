#include "common/models/moving/tool_reach.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/arrays.hpp"

namespace palpate {

ToolReach::Ends ToolReach::ends(const MovingTool& tool) {
  Ends ends{};
  for (int p = 0; p < std::min(tool.size(), kParts); ++p) {
    const Segment axis = tool.axis(p);
    copy(axis.start, ends[2 * p]);
    copy(axis.end, ends[2 * p + 1]);
  }
  return ends;
}

void ToolReach::begin(const MovingTool& tool, double at_start) {
  state_ = {.newer = ends(tool), .older = ends(tool), .at_start = at_start, .begun = 1};
}

// The place that counts is some steps old, as the models are.
void ToolReach::set_free(const MovingTool& tool) {
  state_.at_start = 0;
  if (++state_.lag < kLag) return;
  state_.lag = 0;
  state_.older = state_.newer;
  state_.newer = ends(tool);
}

double ToolReach::of(const MovingTool& tool) const {
  const Ends now = ends(tool);
  double squared = 0;
  for (std::size_t e = 0; e < now.size(); ++e) {
    double distance = 0;
    for (int axis = 0; axis < 3; ++axis)
      distance += (now[e][axis] - state_.older[e][axis]) * (now[e][axis] - state_.older[e][axis]);
    squared = std::max(squared, distance);
  }
  return std::sqrt(squared) + state_.at_start;
}

}  // namespace palpate
