#include "common/contact/patch/surface_place.hpp"

#include <limits>

#include "common/geometry/barycentric.hpp"

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

std::optional<TrianglePoint> highest_along(const SmoothSurface& surface, std::span<const int> triangles,
                                           const Eigen::Vector3d& point, const Eigen::Vector3d& out, double facing) {
  std::optional<TrianglePoint> highest;
  double most = -std::numeric_limits<double>::infinity();
  for (const int t : triangles) {
    const double along = surface.facet_normal(t).dot(out);
    if (along < facing || !surface.may_meet(t, point, out)) continue;
    const Triangle c = surface.corners(t);
    const double s = surface.facet_normal(t).dot(c[0] - point) / along;
    const Eigen::Vector3d w = plane_coordinates(c, point + s * out);
    if (w.minCoeff() < -1e-9 || s < most) continue;
    most = s;
    highest = {t, w};
  }
  return highest;
}

SurfacePlace nearest_place(const SmoothSurface& surface, const Eigen::Vector3d& point, std::span<const int> triangles) {
  const TrianglePoint nearest = nearest_point(surface, point, triangles);
  return place_at(surface, nearest.triangle, nearest.weights);
}

}  // namespace palpate
