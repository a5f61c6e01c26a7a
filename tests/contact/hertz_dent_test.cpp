#include "common/contact/patch/hertz_dent.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palpate {
namespace {

using Eigen::Vector3d;

const HalfSpace kDented{6000, 0.3};
const Vector3d kUp = Vector3d::UnitZ();

HertzDent dent_of(const Vector3d& force, double reach = 1e3) {
  return {Vector3d(0.01, 0.02, 0.03), kUp, force, 0.003, reach, kDented};
}

/// The same by squares, each under what Hertz's pressures are at its middle.
Vector3d by_squares(const HertzDent& dent, const Vector3d& place) {
  constexpr int kAcross = 120;
  const double edge = 2 * dent.disc / kAcross;
  Vector3d sum = Vector3d::Zero();
  double all = 0;
  for (int i = 0; i < kAcross; ++i)
    for (int j = 0; j < kAcross; ++j) {
      const double x = edge * (i + 0.5) - dent.disc, y = edge * (j + 0.5) - dent.disc;
      const double pressure = std::sqrt(std::max(0.0, 1 - (x * x + y * y) / (dent.disc * dent.disc)));
      const Vector3d d = place - dent.middle - Vector3d(x, y, 0);
      sum.head<2>() += pressure * kDented.sheared(d.x(), d.y(), edge) * dent.force.head<2>();
      sum.z() += pressure * kDented.pressed(d.x(), d.y(), edge) * dent.force.z();
      const Eigen::Vector2d crossed = pressure * kDented.crossed(d.x(), d.y(), edge);
      sum.head<2>() += dent.force.z() * crossed;
      sum.z() -= crossed.dot(dent.force.head<2>());
      all += pressure * edge * edge;
    }
  return sum / all;
}

TEST(HertzDent, IsWhatSquaresUnderItsPressuresDoWithinAndBeside) {
  const HertzDent dent = dent_of({0.05, -0.02, -0.1});
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {0.001, -0.0005}, {-0.002, 0.0015}, {0.0031, 0.001}, {0.006, -0.009}})
    EXPECT_LT(
        (dent.field(dent.middle + Vector3d(x, y, 0), kUp) - by_squares(dent, dent.middle + Vector3d(x, y, 0))).norm(),
        0.003 * dent.field(dent.middle, kUp).norm())
        << x << " " << y;
}

TEST(HertzDent, FarAwayIsThatOfAPointForce) {
  const HertzDent dent = dent_of({0.05, -0.02, -0.1});
  const Vector3d d(0.08, -0.05, 0), point = kDented.at(d, kUp) * dent.force;
  EXPECT_LT((dent.field(dent.middle + d, kUp) - point).norm(), 1e-3 * point.norm());
}

// d = a^2 / R, and the ball's round bottom: d - r^2 / 2 R below the disc's middle.
TEST(HertzDent, FollowsTheBallThatPresses) {
  const double radius = 0.006, force = 0.1, disc = HertzDent::disc_under(radius, force, kDented);
  HertzDent dent = dent_of(-force * kUp);
  dent.disc = disc;
  for (const double r : {0.0, 0.3 * disc, 0.9 * disc})
    EXPECT_NEAR(-dent.field(dent.middle + Vector3d(r, 0, 0), kUp).z(), disc * disc / radius - 0.5 * r * r / radius,
                1e-9);
}

TEST(HertzDent, FadesOutTowardsItsReachAndKnowsNothingOfAnotherSide) {
  const HertzDent dent = dent_of(-0.1 * kUp, 0.01);
  const auto at = [&](double r) { return Vector3d(dent.middle + Vector3d(r, 0, 0)); };
  EXPECT_EQ(dent.displacement(at(0.004), kUp), dent.field(at(0.004), kUp));
  EXPECT_LT(-dent.displacement(at(0.007), kUp).z(), -dent.field(at(0.007), kUp).z());
  EXPECT_EQ(dent.displacement(at(0.0101), kUp), Vector3d::Zero());
  EXPECT_EQ(dent.displacement(at(0.001), -kUp), Vector3d::Zero());
}

TEST(HertzDent, ItsSlopeIsThatOfItsRise) {
  const HertzDent dent = dent_of({0.05, -0.02, -0.1}, 0.01);
  for (const double r : {0.001, 0.0029, 0.004, 0.007, 0.009}) {
    const Vector3d place = dent.middle + r * Vector3d(0.6, 0.8, 0), step(1e-7, 0, 0);
    const double by_differences =
        (dent.displacement(place + step, kUp) - dent.displacement(place - step, kUp)).z() / 2e-7;
    EXPECT_NEAR(dent.slope(place, kUp).x(), by_differences, 1e-6) << r;
  }
}

}  // namespace
}  // namespace palpate
