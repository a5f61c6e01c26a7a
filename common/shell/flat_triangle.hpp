#pragma once
#include <Eigen/Core>
#include <array>

namespace palpate {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// A triangle in its own plane: corner 0 at the origin, corner 1 on the positive x axis, corner 2 above it,
/// so that the corners go round counterclockwise.
struct FlatTriangle {
  Eigen::Matrix<double, 2, 3> corner;  ///< [m] one column a corner
  double area = 0;                     ///< [m^2] positive

  /// From corner i to corner j [m].
  Eigen::Vector2d side(int i, int j) const { return corner.col(j) - corner.col(i); }
  double longest_side() const;
  /// Column i: gradient of the barycentric coordinate i [1/m].
  Eigen::Matrix<double, 2, 3> gradients() const;
};

/// Where a triangle of space has its plane. BHS01 lays y along the side 1-2 and numbers clockwise; here x
/// lies there and the corners go counterclockwise, which is the same frame mirrored.
struct TriangleFrame {
  Eigen::Matrix3d axes;  ///< rows: the local x, y, z axes in the world; z is the normal by the right-hand rule
  FlatTriangle flat;
};

/// Throws std::runtime_error if the corners lie on a line.
TriangleFrame triangle_frame(const std::array<Eigen::Vector3d, 3>& corners);

}  // namespace palpate
