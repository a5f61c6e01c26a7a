#include "common/shell/flat_triangle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

namespace palpate {
namespace {

/// Least height over longest side. A flatter triangle's plane is rounding.
constexpr double kFlattest = 1e-10;

}  // namespace

double FlatTriangle::longest_side() const {
  return std::max({side(0, 1).norm(), side(1, 2).norm(), side(2, 0).norm()});
}

Eigen::Matrix<double, 2, 3> FlatTriangle::gradients() const {
  Eigen::Matrix<double, 2, 3> gradient;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d opposite = side((i + 1) % 3, (i + 2) % 3);
    gradient.col(i) = Eigen::Vector2d(-opposite.y(), opposite.x()) / (2 * area);
  }
  return gradient;
}

TriangleFrame triangle_frame(const std::array<Eigen::Vector3d, 3>& corners) {
  const Eigen::Vector3d along = corners[1] - corners[0], across = corners[2] - corners[0];
  const double longest2 =
      std::max({along.squaredNorm(), across.squaredNorm(), (corners[2] - corners[1]).squaredNorm()});
  const Eigen::Vector3d normal = along.cross(across);
  if (!(normal.norm() > kFlattest * longest2)) throw std::runtime_error("its corners lie on a line");

  const Eigen::Vector3d x = along.normalized(), z = normal.normalized(), y = z.cross(x);
  TriangleFrame frame;
  frame.axes << x.transpose(), y.transpose(), z.transpose();
  frame.flat.corner << 0, along.norm(), x.dot(across), 0, 0, y.dot(across);
  frame.flat.area = 0.5 * normal.norm();
  return frame;
}

}  // namespace palpate
