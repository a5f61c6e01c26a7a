#include <gtest/gtest.h>

#include <functional>

#include "common/geometry/dense_solvers.hpp"
#include "common/shell/membrane.hpp"
#include "common/shell/shell_element.hpp"
#include "tests/shell/irregular_shells.hpp"

namespace palpate {
namespace {

using testing::kWall;
using Corners = std::array<Eigen::Vector3d, 3>;

const Corners kScalene{Eigen::Vector3d(0.1, 0.2, -0.3), Eigen::Vector3d(1.2, 0.4, 0.1), Eigen::Vector3d(0.5, 1.3, 0.2)};
const Corners kIsosceles{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.01, 0, 0), Eigen::Vector3d(0, 0.01, 0)};
constexpr std::array kBoth{Bending::discrete_kirchhoff, Bending::polynomial};

std::string refusal(const Corners& corners, Bending bending) {
  try {
    shell_element_stiffness(corners, kWall, bending);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

/// Values from the seventh eigenvalue on, over the largest; the first six belong to rigid motions.
template <class Matrix>
std::pair<double, double> spectrum(const Matrix& stiffness, int rigid) {
  const Eigen::VectorXd values = symmetric_eigenvalues(stiffness);
  const double largest = values[values.size() - 1];
  return {values.head(rigid).cwiseAbs().maxCoeff() / largest, values[rigid] / largest};
}

TEST(ShellFrame, IsRightHandedWithItsFirstSideAlongX) {
  const auto [axes, flat] = triangle_frame(kScalene);
  EXPECT_TRUE((axes * axes.transpose()).isIdentity(1e-14));
  EXPECT_NEAR(axes.determinant(), 1, 1e-14);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d back =
        kScalene[0] + axes.transpose() * Eigen::Vector3d(flat.corner(0, i), flat.corner(1, i), 0);
    EXPECT_TRUE(back.isApprox(kScalene[i], 1e-14)) << i;
  }
  EXPECT_GT(flat.corner(0, 1), 0);
  EXPECT_GT(flat.corner(1, 2), 0);
}

TEST(ShellElement, RefusesCornersOnALine) {
  const Corners line{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(3, 3, 3)};
  for (auto bending : kBoth) EXPECT_EQ(refusal(line, bending), "its corners lie on a line");
}

TEST(Membrane, HasRankSixSoThatTheDrillingRotationIsStiff) {
  for (double poisson : {0.0, 0.3, 0.45, 0.4999}) {
    const auto flat = triangle_frame(kScalene).flat;
    const auto [rigid, softest] = spectrum(membrane_stiffness(flat, plane_stress(1, poisson), poisson), 3);
    EXPECT_LT(rigid, 1e-15) << poisson;
    EXPECT_GT(softest, 1e-4) << poisson;
  }
}

TEST(Bending, HasRankSix) {
  const auto flat = triangle_frame(kScalene).flat;
  for (auto bending : kBoth) {
    const auto [rigid, softest] = spectrum(bending_stiffness(bending, flat, plane_stress(1, 0.3)), 3);
    EXPECT_LT(rigid, 1e-14);
    EXPECT_GT(softest, 1e-3);
  }
}

TEST(ShellElement, IsSymmetricAndSemidefiniteInAnyOrientation) {
  for (auto bending : kBoth) {
    const auto k = shell_element_stiffness(kScalene, kWall, bending);
    EXPECT_LT((k - k.transpose()).norm(), 1e-14 * k.norm());
    const auto [rigid, softest] = spectrum(k, 6);
    EXPECT_LT(rigid, 1e-14);
    EXPECT_GT(softest, 1e-7);
  }
}

TEST(ShellElement, TurnsWithTheTriangle) {
  const Eigen::Matrix3d turn = testing::some_turn();
  const Corners turned{turn * kScalene[0], turn * kScalene[1], turn * kScalene[2]};
  for (auto bending : kBoth) {
    auto expected = shell_element_stiffness(kScalene, kWall, bending);
    for (int i = 0; i < 18; i += 3)
      for (int j = 0; j < 18; j += 3) {
        const Eigen::Matrix3d block = expected.block<3, 3>(i, j);
        expected.block<3, 3>(i, j) = turn * block * turn.transpose();
      }
    EXPECT_TRUE(shell_element_stiffness(turned, kWall, bending).isApprox(expected, 1e-12));
  }
}

/// How far the stiffness changes when the corners are named in another order, or the face looks the other
/// way.
double change_by_renumbering(Bending bending, const std::array<int, 3>& order) {
  const auto k = shell_element_stiffness(kScalene, kWall, bending);
  const auto other =
      shell_element_stiffness({kScalene[order[0]], kScalene[order[1]], kScalene[order[2]]}, kWall, bending);
  double change = 0;
  for (int i = 0; i < 18; ++i)
    for (int j = 0; j < 18; ++j)
      change = std::max(change, std::abs(other(i, j) - k(6 * order[i / 6] + i % 6, 6 * order[j / 6] + j % 6)));
  return change / k.cwiseAbs().maxCoeff();
}

TEST(ShellElement, KnowsNoFirstCornerAndNoFaceWithDiscreteKirchhoff) {
  for (const auto& order : {std::array{1, 2, 0}, std::array{2, 0, 1}, std::array{1, 0, 2}, std::array{0, 2, 1}})
    EXPECT_LT(change_by_renumbering(Bending::discrete_kirchhoff, order), 1e-13);
}

TEST(ShellElement, DependsOnTheFirstCornerWithThePolynomial) {
  for (const auto& order : {std::array{1, 2, 0}, std::array{2, 0, 1}, std::array{1, 0, 2}})
    EXPECT_GT(change_by_renumbering(Bending::polynomial, order), 1e-5);
}

/// Energy of a rectangle cut in two that is bent in its plane, over that of a beam: Felippa's bending ratio.
double bending_ratio(double length, double height, double poisson) {
  const double curvature = 1e-3;
  const auto corner = [&](int i, int j) { return Eigen::Vector3d(i * length, (j - 0.5) * height, 0); };
  double energy = 0;
  for (const Corners& corners :
       {Corners{corner(0, 0), corner(1, 0), corner(1, 1)}, Corners{corner(0, 0), corner(1, 1), corner(0, 1)}}) {
    const auto [axes, flat] = triangle_frame(corners);
    const Eigen::Matrix2d plane = axes.topLeftCorner<2, 2>();
    Eigen::Vector<double, 9> u;
    for (int i = 0; i < 3; ++i) {
      const double x = corners[i].x(), y = corners[i].y();
      u.segment<2>(3 * i) = plane * curvature * Eigen::Vector2d(-x * y, 0.5 * (x * x + poisson * y * y));
      u[3 * i + 2] = curvature * x;
    }
    energy += 0.5 * u.dot(membrane_stiffness(flat, plane_stress(1, poisson), poisson) * u);
  }
  return energy / (0.5 * height * height * height / 12 * curvature * curvature * length);
}

TEST(Membrane, BendsInItsPlaneLikeABeamAtAnyAspectRatio) {
  for (double poisson : {0.0, 0.25, 0.3, 0.45})
    for (double aspect : {0.1, 1.0, 4.0, 16.0, 100.0}) {
      // The energies of the parts cancel by as much as the fourth power of the aspect ratio.
      const double rounding = 1e-12 + 3e-15 * std::pow(aspect, 4);
      EXPECT_NEAR(bending_ratio(aspect, 1, poisson), 1, rounding) << "nu " << poisson << ", aspect " << aspect;
    }
}

TEST(Bending, HoldsTheEnergyOfAConstantCurvature) {
  const auto flat = triangle_frame(kScalene).flat;
  const Eigen::Matrix3d rigidity = plane_stress(1, 0.3);
  const Eigen::Vector3d curvature(0.7, -0.4, 0.5);  // w_xx, w_yy, 2 w_xy
  Eigen::Vector<double, 9> u;
  for (int i = 0; i < 3; ++i) {
    const double x = flat.corner(0, i), y = flat.corner(1, i);
    u[3 * i] = 0.5 * (curvature[0] * x * x + curvature[1] * y * y + curvature[2] * x * y);
    u[3 * i + 1] = curvature[1] * y + 0.5 * curvature[2] * x;
    u[3 * i + 2] = -(curvature[0] * x + 0.5 * curvature[2] * y);
  }
  const double energy = 0.5 * flat.area * curvature.dot(rigidity * curvature);
  for (auto bending : kBoth)
    EXPECT_NEAR(0.5 * u.dot(bending_stiffness(bending, flat, rigidity) * u), energy, 1e-13 * energy);
}

TEST(PolynomialBending, HoldsTheEnergyOfItsOwnCubics) {
  // w = p x^3 + q (x^2 y + x y^2) + r y^3 in the triangle's frame.
  const double p = 0.8, q = -0.5, r = 0.3;
  const auto flat = triangle_frame(kScalene).flat;
  const Eigen::Matrix3d rigidity = plane_stress(1, 0.3);
  Eigen::Vector<double, 9> u;
  double energy = 0;
  for (int i = 0; i < 3; ++i) {
    const double x = flat.corner(0, i), y = flat.corner(1, i);
    u[3 * i] = p * x * x * x + q * (x * x * y + x * y * y) + r * y * y * y;
    u[3 * i + 1] = q * (x * x + 2 * x * y) + 3 * r * y * y;
    u[3 * i + 2] = -(3 * p * x * x + q * (2 * x * y + y * y));
    // Three inner points integrate squares of linear functions exactly.
    const Eigen::Vector2d at = (flat.corner.rowwise().sum() + 3 * flat.corner.col(i)) / 6;
    const Eigen::Vector3d curvature(6 * p * at.x() + 2 * q * at.y(), 2 * q * at.x() + 6 * r * at.y(),
                                    4 * q * (at.x() + at.y()));
    energy += 0.5 * flat.area / 3 * curvature.dot(rigidity * curvature);
  }
  EXPECT_NEAR(0.5 * u.dot(polynomial_stiffness(flat, rigidity) * u), energy, 1e-12 * energy);
}

TEST(PolynomialBending, IsRefusedWhereItsInterpolationIsSingularAtAnySize) {
  for (double size : {1e-6, 1.0, 1e6}) {
    Corners corners = kIsosceles;
    for (auto& x : corners) x = testing::some_turn() * x * size;
    EXPECT_NE(refusal(corners, Bending::polynomial).find("singular"), std::string::npos) << size;
    EXPECT_EQ(refusal(corners, Bending::discrete_kirchhoff), "") << size;
  }
}

TEST(PolynomialBending, IsTakenWhenTheRightAngleIsAtAnotherCorner) {
  for (int first : {1, 2})
    EXPECT_EQ(
        refusal({kIsosceles[first], kIsosceles[(first + 1) % 3], kIsosceles[(first + 2) % 3]}, Bending::polynomial),
        "");
}

/// The paper's determinant of the interpolation, x3^5 y2^5 (x3 + 2 y3 - y2), seen through the stiffness: the
/// strain energy grows with the inverse square of the last factor.
TEST(PolynomialBending, StiffensWithTheInverseSquareOfTheVanishingFactor) {
  const auto largest = [](double factor) {
    const FlatTriangle flat =
        triangle_frame({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(factor / 2, 1, 0)}).flat;
    return polynomial_stiffness(flat, plane_stress(1, 0.3)).norm();
  };
  EXPECT_NEAR(largest(0.01) / largest(0.02), 4, 0.2);
  EXPECT_NEAR(largest(0.005) / largest(0.01), 4, 0.1);
}

}  // namespace
}  // namespace palpate
