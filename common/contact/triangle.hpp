#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>

namespace palpate {

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Closest point of a triangle to p.
struct ClosestPoint {
  Eigen::Vector3d weights;  ///< barycentric, non-negative, sum 1
  double squared_distance;  ///< [m^2]
};
ClosestPoint closest_point(const Eigen::Vector3d& p, const Triangle& triangle);

/// First time at which a point that moves linearly crosses a triangle whose corners move linearly.
struct SweptHit {
  double time;               ///< in [0, 1]
  Eigen::Vector3d weights;   ///< barycentric coordinates of the crossing
  bool from_outside;         ///< the point passes against the triangle's normal (from its outer side)
};
std::optional<SweptHit> sweep_point(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Triangle& triangle0,
                                    const Triangle& triangle1);

}  // namespace palpate
