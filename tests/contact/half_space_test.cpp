#include "common/contact/patch/half_space.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const HalfSpace kTissue{6000, 0.3};

Matrix3d sum_of(const std::array<std::array<Matrix3d, 3>, 3>& moments) {
  Matrix3d sum = Matrix3d::Zero();
  for (const auto& row : moments)
    for (const Matrix3d& m : row) sum += m;
  return sum;
}

TEST(HalfSpace, TheMiddleOfAPressedSquareGivesWayAsLoveSays) {
  const double edge = 0.002, in_theory = 4 * edge * std::asinh(1.0) * (1 - 0.09) / (std::numbers::pi * 6000);
  EXPECT_NEAR(kTissue.pressed(0, 0, edge), in_theory, 1e-12 * in_theory);
}

TEST(HalfSpace, FarFromASquareItIsAPointForce) {
  const double edge = 0.002, x = 0.05, y = 0.03;
  const Matrix3d point = kTissue.at({x, y, 0}, Vector3d::UnitZ()) * edge * edge;
  EXPECT_NEAR(kTissue.pressed(x, y, edge), point(2, 2), 1e-3 * point(2, 2));
  EXPECT_LT((kTissue.sheared(x, y, edge) - point.topLeftCorner<2, 2>()).norm(), 1e-3 * point(0, 0));
}

// Sheared along x, the tissue gives way more along x than beside: the closed forms against a fine quadrature.
TEST(HalfSpace, AShearedSquareAgreesWithQuadrature) {
  const double edge = 0.002, x = 0.0017, y = -0.0006;
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  double pressed = 0;
  Eigen::Vector2d into(0, 0), drawn(0, 0);
  constexpr int kCells = 400;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const double px = edge * ((i + 0.5) / kCells - 0.5), py = edge * ((j + 0.5) / kCells - 0.5);
      const Matrix3d k = kTissue.at({x - px, y - py, 0}, Vector3d::UnitZ()) * edge * edge / (kCells * kCells);
      sum += k.topLeftCorner<2, 2>();
      pressed += k(2, 2);
      into -= k.bottomLeftCorner<1, 2>().transpose();
      drawn -= k.topRightCorner<2, 1>();  // what presses points downwards
    }
  EXPECT_LT((kTissue.sheared(x, y, edge) - sum).norm(), 1e-4 * sum.norm());
  EXPECT_NEAR(kTissue.pressed(x, y, edge), pressed, 1e-4 * pressed);
  EXPECT_LT((kTissue.crossed(x, y, edge) - into).norm(), 1e-4 * pressed);
  EXPECT_LT((kTissue.crossed(x, y, edge) + drawn).norm(), 1e-4 * pressed);
  EXPECT_LT(drawn.dot(Eigen::Vector2d(x, y)), 0) << "towards what presses";
}

TEST(HalfSpace, OfSquaresThatAreCompressedNothingIsDrawnAcrossWhereTheVolumeStays) {
  EXPECT_EQ(HalfSpace(6000, 0.5).crossed(0.001, 0.002, 0.002).norm(), 0);
}

// The integral of 1/r between a unit square and itself is 2.97321 (Eidus and others, mean distance's inverse).
TEST(HalfSpace, ASquareOfTwoTrianglesOnItselfGivesTheKnownIntegral) {
  const Triangle a{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 1, 0)};
  const Triangle b{Vector3d(0, 0, 0), Vector3d(1, 1, 0), Vector3d(0, 1, 0)};
  const HalfSpace unit{1 / std::numbers::pi, 0};  // its kernel is 1/r in every direction
  Matrix3d sum = Matrix3d::Zero();
  for (const Triangle& s : {a, b})
    for (const Triangle& t : {a, b}) sum += sum_of(kernel_moments(unit, s, t, Vector3d::UnitZ()));
  const double exact = 4 * std::log(1 + std::numbers::sqrt2) - 4.0 / 3 * (std::numbers::sqrt2 - 1);
  EXPECT_NEAR(exact, 2.97321, 1e-5);
  EXPECT_NEAR(sum(0, 0), exact, 5e-3 * exact);
  EXPECT_NEAR(sum(2, 2), exact, 5e-3 * exact);
  EXPECT_NEAR(sum(0, 2), 0, 1e-9);
}

TEST(HalfSpace, TheNearAndTheFarQuadratureMeet) {
  const Triangle s{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  const auto at = [&](double x) {
    Triangle t = s;
    for (Vector3d& c : t) c.x() += x;
    return kernel_moments(kTissue, s, t, Vector3d::UnitZ());
  };
  const auto near = at(2.999), far = at(3.001);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) EXPECT_LT((near[a][b] - far[a][b]).norm(), 3e-3 * near[a][b].norm()) << a << " " << b;
}

}  // namespace
}  // namespace palpate
