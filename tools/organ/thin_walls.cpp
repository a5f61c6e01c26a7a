#include "tools/organ/thin_walls.hpp"

#include <algorithm>
#include <limits>

namespace palpate {
namespace {

constexpr double kThinnest = 0.05;  // of the points
constexpr double kParallel = 0.8;   // cosine between the sides of a wall
constexpr double kFarthest = 1e6;   // times what is near: the way misses the surface
constexpr double kRounding = 1e-9;  // of a depth

/// Infinite where it meets no surface that lies nearly parallel to that at the point: there is an edge, or a corner.
double thickness_at(const SurfacePoint& point, const DepthUpTo& depth, double near, const DepthUpTo& exact) {
  constexpr int kSteps = 1000;
  double deep = 3 * near;
  for (int i = 0; i < kSteps && deep < kFarthest * near; ++i) {
    const double free = depth(point.place + deep * point.inward, deep);  // the point itself is no farther
    if (free < near) break;
    deep += free;
  }
  const double middle = 0.5 * deep, least = kParallel * middle;
  const auto is_wall = [&](const DepthUpTo& deep_by) {
    return deep_by(point.place + middle * point.inward, least) > (1 - kRounding) * least;
  };
  const Eigen::Vector3d end = point.place + deep * point.inward;  // of the way, on the other side if that is exact
  return is_wall(depth) || (exact && exact(end, 2 * near) < 2 * near && is_wall(exact))
             ? deep
             : std::numeric_limits<double>::infinity();
}

}  // namespace

ThinWall thin_wall(const std::vector<SurfacePoint>& points, const DepthUpTo& depth, double near,
                   const DepthUpTo& exact) {
  std::vector<ThinWall> walls;
  for (const SurfacePoint& point : points) walls.push_back({thickness_at(point, depth, near, exact), point.place});
  const auto chosen = walls.begin() + static_cast<std::ptrdiff_t>(kThinnest * static_cast<double>(walls.size()));
  std::ranges::nth_element(walls, chosen, {}, &ThinWall::thickness);
  return *chosen;
}

}  // namespace palpate
