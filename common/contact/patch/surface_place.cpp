#include "common/contact/patch/surface_place.hpp"

#include <limits>

namespace palpate {

SurfacePlace place_at(const SmoothSurface& surface, int triangle, const Eigen::Vector3d& weights) {
  const Triangle corner = surface.corners(triangle);
  return {weights[0] * corner[0] + weights[1] * corner[1] + weights[2] * corner[2], -surface.normal(triangle, weights),
          triangle};
}

TrianglePoint nearest_point(const SmoothSurface& surface, const Eigen::Vector3d& point,
                            std::span<const int> triangles) {
  ClosestPoint closest{Eigen::Vector3d::Unit(0), std::numeric_limits<double>::infinity()};
  int best = triangles.front();
  for (const int t : triangles) {
    const ClosestPoint p = closest_point(point, surface.corners(t));
    if (p.squared_distance >= closest.squared_distance) continue;
    closest = p;
    best = t;
  }
  return {best, closest.weights};
}

SurfacePlace nearest_place(const SmoothSurface& surface, const Eigen::Vector3d& point, std::span<const int> triangles) {
  const TrianglePoint nearest = nearest_point(surface, point, triangles);
  return place_at(surface, nearest.triangle, nearest.weights);
}

}  // namespace palpate
