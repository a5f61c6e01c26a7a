#include "tools/organ/thin_walls.hpp"

#include <algorithm>

namespace palpate {
namespace {

constexpr double kThinnest = 0.05;  // of the points

double thickness_at(const SurfacePoint& point, const std::function<double(const Eigen::Vector3d&)>& distance,
                    double near) {
  constexpr int kSteps = 1000;
  double deep = 3 * near;
  for (int i = 0; i < kSteps; ++i) {
    const double free = distance(point.place + deep * point.inward);
    if (free < near) break;
    deep += free;
  }
  return deep;
}

}  // namespace

ThinWall thin_wall(const std::vector<SurfacePoint>& points,
                   const std::function<double(const Eigen::Vector3d&)>& distance, double near) {
  std::vector<ThinWall> walls;
  for (const SurfacePoint& point : points) walls.push_back({thickness_at(point, distance, near), point.place});
  const auto chosen = walls.begin() + static_cast<std::ptrdiff_t>(kThinnest * static_cast<double>(walls.size()));
  std::ranges::nth_element(walls, chosen, {}, &ThinWall::thickness);
  return *chosen;
}

}  // namespace palpate
