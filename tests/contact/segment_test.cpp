#include "common/geometry/segment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate {
namespace {

using Eigen::Vector3d;

class Random {
 public:
  explicit Random(int seed) : engine_(seed) {}
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Vector3d point() { return {number(-1, 1), number(-1, 1), number(-1, 1)}; }
  Segment segment() { return {point(), point()}; }

 private:
  std::mt19937 engine_;
};

double distance(const Segment& s, const Vector3d& p) {
  return (nearest_point(s, p) - p).norm();
}

TEST(Segments, ThePairFoundIsNearerThanAnyOtherOfADenseGrid) {
  Random random(3);
  for (int round = 0; round < 300; ++round) {
    const Segment a = random.segment();
    Segment b = random.segment();
    if (round % 4 == 1) b = {b.start, b.start + random.number(-2, 2) * (a.end - a.start)};  // parallel
    if (round % 4 == 2) b.end = b.start;
    const ClosestOfSegments found = closest_points(a, b);
    ASSERT_NEAR(std::sqrt(found.squared_distance), (a.at(found.share_a) - b.at(found.share_b)).norm(), 1e-12);
    double least = 10;
    for (int i = 0; i <= 1000; ++i) least = std::min(least, distance(b, a.at(i / 1000.0)));
    const double error = std::sqrt(found.squared_distance) - least;
    ASSERT_LT(error, 1e-9) << "round " << round;
    ASSERT_GT(error, -2e-3) << "round " << round;  // half a step of the grid
  }
}

TEST(Segments, ParallelOnesMeetInTheMiddleOfWhereTheyRunBesideEachOther) {
  const Segment a{{0, 0, 0}, {10, 0, 0}}, b{{12, 1, 0}, {4, 1, 0}};
  const ClosestOfSegments found = closest_points(a, b);
  EXPECT_NEAR(a.at(found.share_a).x(), 7, 1e-12);
  EXPECT_NEAR(b.at(found.share_b).x(), 7, 1e-12);
  EXPECT_NEAR(found.squared_distance, 1, 1e-12);
}

TEST(SegmentAndTriangle, ThePairFoundIsNearerThanAnyOtherOfADenseGrid) {
  Random random(4);
  int meeting = 0;
  for (int round = 0; round < 300; ++round) {
    Segment s = random.segment();
    const Triangle t{random.point(), random.point(), random.point()};
    if (round % 3 == 1) s.end = s.start;
    if (round % 3 == 2) s.end = s.start + 0.7 * (t[1] - t[0]) + 0.2 * (t[2] - t[0]);  // along the plane
    const ClosestOfTriangle found = closest_points(s, t);
    const Vector3d at = found.weights[0] * t[0] + found.weights[1] * t[1] + found.weights[2] * t[2];
    ASSERT_NEAR(found.weights.sum(), 1, 1e-12);
    ASSERT_GE(found.weights.minCoeff(), 0);
    ASSERT_NEAR((s.at(found.share) - at).norm(), std::sqrt(found.squared_distance), 1e-12);
    double least = 10;
    for (int i = 0; i <= 1000; ++i)
      least = std::min(least, std::sqrt(closest_point(s.at(i / 1000.0), t).squared_distance));
    const double error = std::sqrt(found.squared_distance) - least;
    ASSERT_LT(error, 1e-9) << "round " << round;
    ASSERT_GT(error, -2e-3) << "round " << round;
    meeting += found.squared_distance < 1e-20;
  }
  EXPECT_GT(meeting, 5);  // some pass through
}

TEST(SegmentAndTriangle, AlongAPlaneTheMiddleOfTheLevelPartIsTaken) {
  const Triangle t{Vector3d(0, -1, 0), Vector3d(4, -1, 0), Vector3d(4, 3, 0)};
  const Segment level{{-1, 0, 0.5}, {9, 0, 0.5}};  // above the triangle from x = 1 to 4
  const double share = level_share(level, t, closest_points(level, t).share, 1e-9);
  EXPECT_NEAR(level.at(share).x(), 2.5, 1e-3);
  const Segment sinking{{-1, 0, 0.5}, {9, 0, -0.1}};  // nearest just beyond the far border
  const double tie = 0.06, nearest = closest_points(sinking, t).share;
  const auto distance_at = [&](double s) { return std::sqrt(closest_point(sinking.at(s), t).squared_distance); };
  double low = 1, high = 0;
  for (int i = 0; i <= 100000; ++i)
    if (distance_at(i / 1e5) <= distance_at(nearest) + tie) low = std::min(low, i / 1e5), high = i / 1e5;
  EXPECT_NEAR(level_share(sinking, t, nearest, tie), 0.5 * (low + high), 1e-3);
}

TEST(Touching, APointAheadIsMetOnTheShortestWay) {
  const Segment axis{{0, 0, 0}, {10, 0, 0}};
  const Touching beside = touching(axis, 1, {4, 0.6, -2}, -Vector3d::UnitZ(), 2);
  EXPECT_NEAR((beside.centre - Vector3d(4, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((beside.normal - Vector3d(0, 0.6, -2).normalized()).norm(), 0, 1e-12);
  const Touching at_end = touching(axis, 1, {11, 0, -1}, -Vector3d::UnitZ(), 2);
  EXPECT_NEAR((at_end.normal - Vector3d(1, 0, -1).normalized()).norm(), 0, 1e-12);
}

TEST(Touching, APointThatWasPassedIsLedOutOnTheSideWhereContactBegan) {
  Random random(6);
  const Segment axis{{0, 0, 0}, {10, 0, 0}};
  for (int round = 0; round < 1000; ++round) {
    const Vector3d side = random.point().normalized();
    const Vector3d point(random.number(0, 10), random.number(-0.9, 0.9), random.number(-0.4, 0.4));
    const Touching found = touching(axis, 1, point, side, random.number(0, 12));
    ASSERT_NEAR(found.normal.norm(), 1, 1e-9);
    ASSERT_GE(found.normal.dot(side), -0.1) << "round " << round;  // along the axis `side` hardly decides
    ASSERT_LT(distance(axis, found.centre), 1e-9);
    // Led out of the part, it is on its surface and not within it.
    if (distance(axis, point) >= 1) continue;
    ASSERT_GT(distance(axis, found.centre + found.normal), 1 - 1e-9) << "round " << round;
  }
}

TEST(Touching, APartThrustOverAPointEndFirstPushesItOnAheadOfItsEnd) {
  const Segment axis{{0, 0, 0}, {0, 0, -10}};  // thrust along -z
  const Vector3d side = Vector3d(0.2, 0, -1).normalized(), point(0.3, 0, -9.5);
  const Touching found = touching(axis, 1, point, side, 2);
  EXPECT_NEAR((found.centre - axis.end).norm(), 0, 1e-12);
  EXPECT_GT(found.normal.dot(side), 0.8);
}

TEST(Touching, APointFarFromTheEndsIsLedOutAcrossTheAxis) {
  const Segment axis{{0, 0, 0}, {0, 0, -10}};
  const Vector3d side = Vector3d(0.3, 0, -1).normalized();
  const Touching found = touching(axis, 1, {-0.2, 0.5, -4}, side, 2);
  EXPECT_NEAR((found.centre - Vector3d(0, 0, -4)).norm(), 0, 1e-12);
  EXPECT_NEAR(found.normal.z(), 0, 1e-12);
  EXPECT_GT(found.normal.dot(side), 0);
}

TEST(Touching, APointNearTheAxisIsMetOnItsSideWhereverAboutTheAxisItLies) {
  Random random(8);
  const Vector3d side = -Vector3d::UnitZ();
  for (const Segment& axis : {Segment{{0, 0, 0}, {10, 0, 0}}, Segment{{5, 0, 0}, {5, 0, 0}}})
    for (int round = 0; round < 1000; ++round) {
      const Vector3d point = Vector3d(5, 0, 0) + 0.05 * random.point();
      ASSERT_GT(touching(axis, 1, point, side, 2).normal.dot(side), 0.99) << "round " << round;
    }
}

TEST(Touching, TheNormalTurnsEvenlyAsAPointComesToLieBehind) {
  const Segment axis{{0, 0, 0}, {10, 0, 0}};
  const Vector3d side = -Vector3d::UnitZ();
  Vector3d last = touching(axis, 1, {5, 0.6, -0.6}, side, 2).normal;
  for (double z = -0.6; z < 0.3; z += 1e-3) {
    const Vector3d normal = touching(axis, 1, {5, 0.6, z}, side, 2).normal;
    ASSERT_LT((normal - last).norm(), 0.01) << z;
    last = normal;
  }
}

TEST(Touching, ASegmentOfNoLengthIsASphere) {
  Random random(7);
  for (int round = 0; round < 1000; ++round) {
    const Vector3d centre = random.point(), point = centre + 0.7 * random.point(), side = random.point().normalized();
    const Vector3d d = point - centre;
    const Touching found = touching({centre, centre}, 0.8, point, side, 0);
    ASSERT_EQ(found.centre, centre);
    if (d.dot(side) > 0 && d.norm() >= 0.8) {
      ASSERT_LT((found.normal - d.normalized()).norm(), 1e-15);
    } else {
      const Vector3d lateral = d - d.dot(side) * side;
      if (lateral.norm() < 0.8) {
        ASSERT_LT((0.8 * found.normal - lateral - std::sqrt(0.64 - lateral.squaredNorm()) * side).norm(), 1e-12);
      } else {
        ASSERT_EQ(found.normal, side);
      }
    }
  }
}

}  // namespace
}  // namespace palpate
