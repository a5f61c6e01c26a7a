#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>

#include "common/contact/patch/smooth_surface.hpp"

namespace palpate {

/// A place of a surface at rest, and along what it is pressed there.
struct SurfacePlace {
  Eigen::Vector3d point;   ///< [m]
  Eigen::Vector3d inward;  ///< unit
  int triangle;            ///< of the surface map
};

/// Where the middle of a ball is [m] that presses a place by a depth [m].
inline Eigen::Vector3d centre_at(const SurfacePlace& place, double radius, double depth) {
  return place.point + (depth - radius) * place.inward;
}

/// Pressed along the surface's normal, which turns evenly from corner to corner. `weights`: barycentric.
SurfacePlace place_at(const SmoothSurface& surface, int triangle, const Eigen::Vector3d& weights);

/// A point of one of a surface's triangles.
struct TrianglePoint {
  int triangle;             ///< of the surface map
  Eigen::Vector3d weights;  ///< barycentric
};

/// The nearest of some triangles, one at least.
TrianglePoint nearest_point(const SmoothSurface& surface, const Eigen::Vector3d& point, std::span<const int> triangles);
/// The outermost place where the line through a point along `out` meets some triangles whose normals are at least as
/// near to `out` as `facing` says, a cosine; none where it meets none.
std::optional<TrianglePoint> highest_along(const SmoothSurface& surface, std::span<const int> triangles,
                                           const Eigen::Vector3d& point, const Eigen::Vector3d& out, double facing);
SurfacePlace nearest_place(const SmoothSurface& surface, const Eigen::Vector3d& point, std::span<const int> triangles);

}  // namespace palpate
