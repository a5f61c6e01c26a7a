#include "common/geometry/triangle.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

namespace palpate {
namespace {

using Eigen::Vector3d;

const Triangle kUnit{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};  // its normal is +z

Vector3d point(const Triangle& t, const Vector3d& weights) {
  return weights[0] * t[0] + weights[1] * t[1] + weights[2] * t[2];
}

Triangle shifted(Triangle t, const Vector3d& by) {
  for (Vector3d& p : t) p += by;
  return t;
}

void expect_barycentric(const Vector3d& weights) {
  EXPECT_GE(weights.minCoeff(), 0);
  EXPECT_NEAR(weights.sum(), 1, 1e-14);
}

TEST(ClosestPoint, IsCloserThanEverySampledPoint) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&] { return Vector3d(uniform(random), uniform(random), uniform(random)); };
  const int grid = 60;
  for (int trial = 0; trial < 300; ++trial) {
    const Triangle t{any(), any(), any()};
    const Vector3d p = 1.5 * any();
    const ClosestPoint closest = closest_point(p, t);
    expect_barycentric(closest.weights);
    EXPECT_NEAR((point(t, closest.weights) - p).squaredNorm(), closest.squared_distance, 1e-14);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= grid; ++i)
      for (int j = 0; i + j <= grid; ++j) {
        const Vector3d weights = Vector3d(i, j, grid - i - j) / grid;
        least = std::min(least, (point(t, weights) - p).norm());
      }
    const double distance = std::sqrt(closest.squared_distance);
    EXPECT_LE(distance, least + 1e-14);
    EXPECT_GE(distance, least - 4.0 / grid);
  }
}

TEST(ClosestPoint, LiesAtTheFootOfThePerpendicularAboveTheInside) {
  const ClosestPoint closest = closest_point({0.2, 0.3, -0.7}, kUnit);
  EXPECT_NEAR((closest.weights - Vector3d(0.5, 0.2, 0.3)).norm(), 0, 1e-15);
  EXPECT_NEAR(closest.squared_distance, 0.49, 1e-15);
}

TEST(ClosestPoint, TakesDegenerateTrianglesAsSegmentsAndPoints) {
  const Triangle segment{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(2, 0, 0)};
  const ClosestPoint beside = closest_point({1.5, 1, 0}, segment);
  expect_barycentric(beside.weights);
  EXPECT_NEAR(beside.squared_distance, 1, 1e-15);
  EXPECT_NEAR(point(segment, beside.weights).x(), 1.5, 1e-15);
  const Triangle dot{Vector3d(1, 1, 1), Vector3d(1, 1, 1), Vector3d(1, 1, 1)};
  const ClosestPoint from = closest_point({1, 1, 3}, dot);
  expect_barycentric(from.weights);
  EXPECT_EQ(from.squared_distance, 4);
}

TEST(ClosestPoint, IsRightOnSlivers) {
  for (const double width : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    const Triangle sliver{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0.5, width, 0)};
    const ClosestPoint closest = closest_point({0.7, 0.2, 0.1}, sliver);
    expect_barycentric(closest.weights);
    EXPECT_NEAR(closest.squared_distance, 0.05, 0.5 * width + 1e-15) << width;
    EXPECT_NEAR((point(sliver, closest.weights) - Vector3d(0.7, 0, 0)).norm(), 0, 2 * width + 1e-15) << width;
  }
}

TEST(SweepPoint, CrossesATriangleAtRestWhereAndWhenItShould) {
  const auto hit = sweep_point({0.2, 0.3, 1}, {0.2, 0.3, -3}, kUnit, kUnit);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->time, 0.25, 1e-15);
  EXPECT_NEAR((hit->weights - Vector3d(0.5, 0.2, 0.3)).norm(), 0, 1e-14);
  EXPECT_TRUE(hit->from_outside);
  EXPECT_FALSE(sweep_point({0.2, 0.3, -3}, {0.2, 0.3, 1}, kUnit, kUnit)->from_outside);
  EXPECT_FALSE(sweep_point({0.7, 0.4, 1}, {0.7, 0.4, -1}, kUnit, kUnit));
  EXPECT_FALSE(sweep_point({0.2, 0.3, 1}, {0.2, 0.3, 0.1}, kUnit, kUnit));
}

TEST(SweepPoint, CrossesATriangleThatComesToAPointAtRest) {
  const Vector3d p(0.25, 0.25, 0);
  const auto hit = sweep_point(p, p, shifted(kUnit, {0, 0, -1}), shifted(kUnit, {0, 0, 1}));
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->time, 0.5, 1e-15);
  EXPECT_TRUE(hit->from_outside);
}

TEST(SweepPoint, IsNotCaughtByATriangleThatFliesAlong) {
  const Vector3d motion(3, -2, -5);
  const Vector3d p(0.25, 0.25, 0.001);
  EXPECT_FALSE(sweep_point(p, p + motion, kUnit, shifted(kUnit, motion)));
}

TEST(SweepPoint, FindsEachCrossingOnceWhenStepsEndInThePlane) {
  const Vector3d above(0.2, 0.3, 0.5), on(0.2, 0.3, 0), below(0.2, 0.3, -0.5);
  EXPECT_FALSE(sweep_point(above, on, kUnit, kUnit));
  const auto in = sweep_point(on, below, kUnit, kUnit);
  ASSERT_TRUE(in);
  EXPECT_EQ(in->time, 0);
  EXPECT_TRUE(in->from_outside);
  const auto out = sweep_point(below, on, kUnit, kUnit);
  ASSERT_TRUE(out);
  EXPECT_EQ(out->time, 1);
  EXPECT_FALSE(out->from_outside);
  EXPECT_FALSE(sweep_point(on, above, kUnit, kUnit));
  EXPECT_FALSE(sweep_point(on, on, kUnit, kUnit));
}

TEST(SweepPoint, GivesNothingForDegenerateTrianglesOrNumbersThatAreNone) {
  const Triangle segment{Vector3d(-1, 0, 0), Vector3d(0, 0, 0), Vector3d(1, 0, 0)};
  EXPECT_FALSE(sweep_point({0.5, 0, 1}, {0.5, 0, -1}, segment, segment));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(sweep_point({nan, 0, 1}, {0.2, 0.2, -1}, kUnit, kUnit));
  EXPECT_FALSE(sweep_point({0.2, 0.2, 1}, {0.2, 0.2, nan}, kUnit, shifted(kUnit, {0, 0, 0.1})));
}

}  // namespace
}  // namespace palpate
