#include "common/models/quasi_static/press_by_laws.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "common/fem/newton_solid.hpp"
#include "common/models/quasi_static/nonlinear.hpp"
#include "common/models/quasi_static/press_spots.hpp"
#include "common/models/solid/precompute.hpp"
#include "tools/rig/example_bodies.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kPressRadius = 0.008;

/// A block that is pressed at a few places once for all tests.
struct Pressed {
  Pressed()
      : problem(make_static_problem(block_body<SolidSpec>({}, 0.45), middle_block_mesh(4))),
        surface(make_surface_map(block_body<SolidSpec>({}, 0.45), problem.mesh, problem.dofs)),
        places(press_by_laws(problem, surface, {.ball_radius = kPressRadius, .places = 2}, "block",
                             [this](std::string_view stage, double) { said.emplace_back(stage); })) {}

  StaticProblem problem;
  SurfaceMap surface;
  std::vector<std::string> said;
  std::vector<PressedPlace> places;
};

const Pressed& pressed() {
  static const Pressed once;
  return once;
}

/// Force along a press at a depth, by Newton's method on a mesh of its own.
double direct_force(Law law, const PressedSpot& spot, double depth) {
  int strides = 0;
  NewtonSolid solid(refine_under_ball(pressed().problem, std::array{spot}, {1, 0.3, 0.7, 3000}, strides), law);
  const auto ball = [&](double d) { return Sphere{spot.point + (d - spot.radius) * spot.inward, spot.radius}; };
  return solid.press(ball(0), ball(depth)).force.dot(spot.inward);
}

TEST(PressByLaws, PlacesAreSpreadAndTheirCurvesBeginAlike) {
  ASSERT_EQ(pressed().places.size(), 2u);
  for (const PressedPlace& place : pressed().places) {
    for (const PressedPlace& other : pressed().places)
      if (&place != &other) {
        EXPECT_GT((place.at - other.at).norm(), 2 * kPressRadius);
      }
    EXPECT_GE(place.depth, 0.5 * kPressRadius);
    ASSERT_FALSE(place.force.empty());
    EXPECT_NEAR(place.force[0][1] / place.force[0][0], 1, 0.05);
    EXPECT_GT(std::abs(place.force.back()[1] / place.force.back()[0] - 1), 0.02);
  }
}

TEST(PressByLaws, EveryPressIsToldWithItsRange) {
  ASSERT_EQ(pressed().said.size(), 2u);
  EXPECT_TRUE(pressed().said[0].starts_with("press 1 of 2: to ")) << pressed().said[0];
}

// Where nobody pressed before, and at a depth between those that were pressed.
TEST(PressByLaws, TheCorrectedForceIsTheNeoHookeanOneElsewhere) {
  const BodyNonlinear law(pressed().places);
  const PressedSpot spot{{0.007, -0.004, 0.03}, {0, 0, -1}, kPressRadius};
  for (const PressedPlace& place : pressed().places) EXPECT_GT((place.at - spot.point).norm(), 0.25 * kPressRadius);
  const double depth = 0.47 * kPressRadius, linear = direct_force(Law::linear, spot, depth),
               truth = direct_force(Law::neo_hookean, spot, depth);
  const double corrected = linear * law.at(spot.point).force_scale(linear);
  EXPECT_GT(std::abs(linear / truth - 1), 0.02);
  EXPECT_LT(std::abs(corrected / truth - 1), 0.4 * std::abs(linear / truth - 1));
}

TEST(PressByLaws, ATipThatSlidesFromPlaceToPlaceFeelsNoJump) {
  const BodyNonlinear law(pressed().places);
  const double force = 0.7 * pressed().places[0].force.back()[0];
  const Vector3d from = pressed().places[0].at, to = pressed().places[1].at;
  constexpr int kTicks = 1000;
  double before = law.at(from).force_scale(force), jump = 0, least = before, most = before;
  for (int i = 1; i <= kTicks; ++i) {
    const QuasiNonlinear here = law.at(from + (to - from) * i / kTicks);
    const double now = here.force_scale(force);
    jump = std::max(jump, std::abs(now - std::exchange(before, now)));
    least = std::min(least, now);
    most = std::max(most, now);
    if (i % 50 == 0) {
      EXPECT_LT(here.force_curve().first_fall(), 0) << i;
    }
  }
  EXPECT_GT(most - least, 1e-3);
  EXPECT_LT(jump, 0.02 * (most - least));
}

TEST(PressByLaws, BeyondItsRangeACurveGoesOnAlongItsTangent) {
  const QuasiNonlinear law = BodyNonlinear(pressed().places).at(pressed().places[0].at);
  const double end = law.force_curve().end(), slope = law.force_slope(end);
  EXPECT_NEAR(2 * end * law.force_scale(2 * end), law.force_curve().value(end) + slope * end, 1e-9 * end);
}

TEST(PressSpots, AreAwayFromEdgesAndFixedNodes) {
  const auto spots = choose_spots(pressed().surface, kPressRadius, 3);
  ASSERT_EQ(spots.size(), 3u);
  for (const PressedSpot& spot : spots) {
    EXPECT_NEAR(spot.inward.norm(), 1, 1e-12);
    EXPECT_GT(spot.point.z(), 0.5 * kPressRadius);
  }
}

}  // namespace
}  // namespace palpate
