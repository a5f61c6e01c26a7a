#include "common/shell/bending.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <stdexcept>

namespace palpate {
namespace {

using SlopeMap = Eigen::Matrix<double, 2, 9>;      // (dw/dx, dw/dy) from the dofs
using CurvatureMap = Eigen::Matrix<double, 3, 9>;  // (w_xx, w_yy, 2 w_xy) from the dofs

/// Least x3 + 2 y3 - y2 over the longest side. The stiffness grows with its inverse squared.
constexpr double kMinFactor = 1e-3;

/// Integrates B^T D B, B being linear over the triangle, by its values at the middles of the sides: exact.
template <class CurvatureAt>
Matrix9d integrate(const FlatTriangle& triangle, const Eigen::Matrix3d& rigidity, CurvatureAt&& curvature_at) {
  Matrix9d stiffness = Matrix9d::Zero();
  for (int i = 0; i < 3; ++i) {
    Eigen::Vector3d middle(0.5, 0.5, 0.5);
    middle[i] = 0;
    const CurvatureMap curvature = curvature_at(middle);
    stiffness += triangle.area / 3 * curvature.transpose() * rigidity * curvature;
  }
  return stiffness;
}

/// Slopes at the corners, then at the middles of the sides opposite to them.
std::array<SlopeMap, 6> nodal_slopes(const FlatTriangle& triangle) {
  std::array<SlopeMap, 6> slope;
  for (int i = 0; i < 3; ++i) {
    slope[i].setZero();
    slope[i](0, 3 * i + 2) = -1;
    slope[i](1, 3 * i + 1) = 1;
  }
  for (int i = 0; i < 3; ++i) {
    const int from = (i + 1) % 3, to = (i + 2) % 3;
    const Eigen::Vector2d side = triangle.side(from, to), s = side.normalized();
    slope[3 + i] = (0.5 * Eigen::Matrix2d::Identity() - 0.75 * s * s.transpose()) * (slope[from] + slope[to]);
    slope[3 + i].col(3 * to) += 1.5 / side.norm() * s;
    slope[3 + i].col(3 * from) -= 1.5 / side.norm() * s;
  }
  return slope;
}

/// Adds the curvature of a slope field that varies with the given gradient.
void add_curvature(const SlopeMap& slope, const Eigen::Vector2d& gradient, CurvatureMap& curvature) {
  curvature.row(0) += gradient.x() * slope.row(0);
  curvature.row(1) += gradient.y() * slope.row(1);
  curvature.row(2) += gradient.y() * slope.row(0) + gradient.x() * slope.row(1);
}

/// The nine terms and their derivatives at a point.
struct PolynomialTerms {
  Eigen::Matrix<double, 1, 9> w, w_x, w_y;
  Eigen::Matrix<double, 3, 9> curvature;

  explicit PolynomialTerms(const Eigen::Vector2d& point) {
    const double x = point.x(), y = point.y();
    w << 1, x, y, x * x, x * y, y * y, x * x * x, x * y * (x + y), y * y * y;
    w_x << 0, 1, 0, 2 * x, y, 0, 3 * x * x, y * (2 * x + y), 0;
    w_y << 0, 0, 1, 0, x, 2 * y, 0, x * (x + 2 * y), 3 * y * y;
    curvature.row(0) << 0, 0, 0, 2, 0, 0, 6 * x, 2 * y, 0;
    curvature.row(1) << 0, 0, 0, 0, 0, 2, 0, 2 * x, 6 * y;
    curvature.row(2) << 0, 0, 0, 0, 2, 0, 0, 4 * (x + y), 0;
  }
};

void check_polynomial(const FlatTriangle& triangle) {
  // The nine terms do not change when x and y change places: the paper's x3, y3 and y2 are these.
  const double x3 = triangle.corner(1, 2), y3 = triangle.corner(0, 2), y2 = triangle.corner(0, 1);
  if (std::abs(x3 + 2 * y3 - y2) < kMinFactor * triangle.longest_side())
    throw std::runtime_error(
        "the polynomial bending element is singular here, because x3 + 2 y3 = y2 with y along its side 1-2 "
        "(as in every "
        "right isosceles triangle with the right angle at its first corner); use discrete_kirchhoff");
}

}  // namespace

Matrix9d discrete_kirchhoff_stiffness(const FlatTriangle& triangle, const Eigen::Matrix3d& rigidity) {
  const auto slope = nodal_slopes(triangle);
  const auto gradient = triangle.gradients();
  return integrate(triangle, rigidity, [&](const Eigen::Vector3d& at) {
    CurvatureMap curvature = CurvatureMap::Zero();
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      add_curvature(slope[i], (4 * at[i] - 1) * gradient.col(i), curvature);
      add_curvature(slope[3 + i], 4 * (at[j] * gradient.col(k) + at[k] * gradient.col(j)), curvature);
    }
    return curvature;
  });
}

Matrix9d polynomial_stiffness(const FlatTriangle& triangle, const Eigen::Matrix3d& rigidity) {
  check_polynomial(triangle);
  // In units of the triangle's size the matrix that is inverted keeps its digits at any scale.
  const double size = triangle.longest_side();
  Matrix9d interpolation;
  for (int i = 0; i < 3; ++i) {
    const PolynomialTerms terms(triangle.corner.col(i) / size);
    interpolation.row(3 * i) = terms.w;
    interpolation.row(3 * i + 1) = terms.w_y / size;
    interpolation.row(3 * i + 2) = -terms.w_x / size;
  }
  const Matrix9d coefficients = interpolation.inverse();
  return integrate(triangle, rigidity, [&](const Eigen::Vector3d& at) -> CurvatureMap {
    return PolynomialTerms(triangle.corner * at / size).curvature * coefficients / (size * size);
  });
}

Matrix9d bending_stiffness(Bending bending, const FlatTriangle& triangle, const Eigen::Matrix3d& rigidity) {
  return bending == Bending::polynomial ? polynomial_stiffness(triangle, rigidity)
                                        : discrete_kirchhoff_stiffness(triangle, rigidity);
}

}  // namespace palpate
