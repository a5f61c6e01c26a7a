#pragma once
#include <vector>

#include "common/archive/archive.hpp"
#include "common/fem/refine_graded.hpp"

namespace palpate {

/// Where a ball is to press a body, up to `count` touchable nodes as far from one another as can be: the first amid
/// what serves, each following one the farthest from those chosen. What serves is smooth within the ball's reach and
/// away from what is fixed; less smooth, and nearer, where too little is left. The same surface gives the same nodes.
std::vector<PressedSpot> choose_spots(const SurfaceMap& surface, double radius, int count);

}  // namespace palpate
