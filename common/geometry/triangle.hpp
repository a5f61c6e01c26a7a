#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>

namespace palpate {

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Closest point of a triangle to p. Degenerate triangles (a segment, a point) are taken as what they are.
struct ClosestPoint {
  Eigen::Vector3d weights;  ///< barycentric, non-negative, sum 1
  double squared_distance;  ///< [m^2]
};
ClosestPoint closest_point(const Eigen::Vector3d& p, const Triangle& triangle);

/// Of two squared distances: whether one is less by more than rounding. Triangles that share the nearest edge or corner
/// are equally near, and which of them is taken must not hang on rounding: the first one.
constexpr bool is_nearer(double squared, double than) {
  return squared < (1 - 1e-6) * than;
}

/// First time at which a point that moves linearly crosses a triangle whose corners move linearly.
///
/// Outside is the side of the normal, the triangle's plane included; a crossing is a change of side. So a
/// path that ends in the plane has not crossed yet, and its continuation to the inside crosses at time 0:
/// over a sequence of steps every crossing is found once. A point that touches the plane and returns does not
/// cross.
///
/// The crossing counts if it lies in the triangle or within a tolerance beside it: 1e-9 of the largest
/// distance between point and corners, plus the uncertainty of the crossing time (of rounding, largest for
/// slivers) times the speed. So a point that passes through an edge or a vertex is found by one of the
/// triangles there at least.
struct SweptHit {
  double time;              ///< in [0, 1]
  Eigen::Vector3d weights;  ///< barycentric coordinates of the crossing, non-negative, sum 1
  bool from_outside;        ///< the point passes against the triangle's normal (from its outer side)
};
std::optional<SweptHit> sweep_point(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Triangle& triangle0,
                                    const Triangle& triangle1);

}  // namespace palpate
