#include "common/shell/membrane.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace palpate {
namespace {

constexpr double kSideBending = 1.5;  // alpha_b: rotations bend the sides as a beam's ends would
constexpr double kMinHigherOrder = 0.01;

/// L / t [m]: nodal forces of a constant stress, 9 x 3 (Felippa 2003 eq. 21).
Eigen::Matrix<double, 9, 3> force_lumping(const FlatTriangle& triangle) {
  Eigen::Matrix<double, 9, 3> lumping;
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3, last = (i + 2) % 3;
    const Eigen::Vector2d a = triangle.side(last, i), b = triangle.side(i, next), through = a + b;
    const double x = through.x(), y = through.y();
    lumping.row(3 * i) << y, 0, -x;
    lumping.row(3 * i + 1) << 0, -x, y;
    // A side from p to q under constant stress turns its ends by +- its length squared over 12: the two
    // sides' moments.
    lumping.row(3 * i + 2) << a.y() * a.y() - b.y() * b.y(), a.x() * a.x() - b.x() * b.x(),
        2 * (b.x() * b.y() - a.x() * a.y());
    lumping.row(3 * i + 2) *= kSideBending / 6;
  }
  return 0.5 * lumping;
}

/// Deviations of the corners' rotations from the mean rotation of the triangle, 3 x 9 (eq. 24).
Eigen::Matrix<double, 3, 9> rotation_deviation(const FlatTriangle& triangle) {
  const auto gradient = triangle.gradients();
  Eigen::Matrix<double, 3, 9> deviation = Eigen::Matrix<double, 3, 9>::Zero();
  for (int i = 0; i < 3; ++i) {
    deviation.col(3 * i).setConstant(gradient(1, i) / 2);
    deviation.col(3 * i + 1).setConstant(-gradient(0, i) / 2);
    deviation(i, 3 * i + 2) = 1;
  }
  return deviation;
}

/// Strains along the sides 12, 23, 31 from the Cartesian strains.
Eigen::Matrix3d natural_strain(const FlatTriangle& triangle) {
  Eigen::Matrix3d natural;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d s = triangle.side(i, (i + 1) % 3).normalized();
    natural.row(i) << s.x() * s.x(), s.y() * s.y(), s.x() * s.y();
  }
  return natural;
}

/// Strains along the sides, at corner `corner`, from the deviations of the rotations (eq. 27): Q_1, Q_2, Q_3
/// are one pattern of the coefficients beta_1..9 = 1 2 1, 0 1 -1, -1 -1 -2, turned round the triangle.
Eigen::Matrix3d corner_strain(const FlatTriangle& triangle, int corner) {
  static const Eigen::Matrix3d beta = (Eigen::Matrix3d() << 1, 2, 1, 0, 1, -1, -1, -1, -2).finished();
  Eigen::Matrix3d strain;
  for (int side = 0; side < 3; ++side) {
    const double scale = 2 * triangle.area / (3 * triangle.side(side, (side + 1) % 3).squaredNorm());
    for (int i = 0; i < 3; ++i) strain(side, i) = scale * beta((side + 3 - corner) % 3, (i + 3 - corner) % 3);
  }
  return strain;
}

/// K_theta [N m]: the higher-order strains at the middles of the sides.
Eigen::Matrix3d deviation_stiffness(const FlatTriangle& triangle, const Eigen::Matrix3d& elasticity) {
  const Eigen::Matrix3d from_natural = natural_strain(triangle).inverse();
  const Eigen::Matrix3d natural = from_natural.transpose() * elasticity * from_natural;
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Matrix3d middle = 0.5 * (corner_strain(triangle, i) + corner_strain(triangle, (i + 1) % 3));
    stiffness += triangle.area * middle.transpose() * natural * middle;
  }
  return stiffness;
}

}  // namespace

Eigen::Matrix3d plane_stress(double young, double poisson) {
  Eigen::Matrix3d elasticity;
  elasticity << 1, poisson, 0, poisson, 1, 0, 0, 0, (1 - poisson) / 2;
  return young / (1 - poisson * poisson) * elasticity;
}

Matrix9d membrane_stiffness(const FlatTriangle& triangle, const Eigen::Matrix3d& elasticity, double poisson) {
  const auto lumping = force_lumping(triangle);
  const auto deviation = rotation_deviation(triangle);
  const double higher_order = 0.75 * std::max(0.5 * (1 - 4 * poisson * poisson), kMinHigherOrder);
  return lumping * elasticity * lumping.transpose() / triangle.area +
         higher_order * deviation.transpose() * deviation_stiffness(triangle, elasticity) * deviation;
}

}  // namespace palpate
