// A rough tip that rubs to and fro over the rim of a body, where the elements under it are far softer than a
// half-space, throws nothing: what sticks goes along from one end of its way to the other, and no farther.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/mesh/generators.hpp"
#include "tests/deform/block_bench.hpp"

namespace palpate {
namespace {

using testing::Bench;
using testing::block_scene;

constexpr double kHalf = 0.015, kHeight = 0.025, kTip = 0.005, kWay = 0.004;  // [m]

/// How far the tissue went anywhere [m], and the largest change of the force in a tick, of its largest.
struct Rubbed {
  double far = 0, change = 0;
};

Rubbed rub(double young, double friction, double depth) {
  Scene scene = block_scene();
  MovingSpec& tissue = moving_block_of(scene);
  tissue.material = {young, 0.45, 1000};
  tissue.dynamic.damping = 5;
  scene.contact.friction = friction;
  Tool& tool = scene.tools[0];
  std::get<ProbeSpec>(tool.end).radius = kTip;
  tool.max_force = 1e3;
  tool.max_force_rate = 1e9;
  Bench bench(scene, make_block({-kHalf, -kHalf, 0}, {kHalf, kHalf, kHeight}, {4, 4, 4}));
  Rubbed rubbed;
  double before = 0, largest = 0;
  for (int i = 0; i < 3000; ++i) {
    const double turn = 2 * std::numbers::pi * std::max(0, i - 300) / 800;
    bench.tick(testing::from_above(i, 300, kHeight + kTip, kHeight + kTip - depth), kHalf + kWay * std::sin(turn));
    const double force = bench.force().norm();
    rubbed.change = std::max(rubbed.change, std::abs(force - before));
    largest = std::max(largest, force);
    before = force;
    for (int n = 0; n < bench.organ().mesh().nodes(); ++n)
      rubbed.far = std::max(rubbed.far, bench.organ().model().displacement(n).norm());
    if (rubbed.far > kHeight) break;
  }
  rubbed.change /= largest;
  return rubbed;
}

/// [m] Of what sticks to the tip at one end of its way, and at the other is pressed as it is without friction.
double farthest_stuck(double smooth) {
  return 1.05 * std::hypot(2 * kWay, smooth);
}

TEST(RubbedRim, ThrowsNothingAndDoesNotBuzz) {
  for (const double depth : {0.003, 0.005}) {
    const double smooth = rub(1e5, 0, depth).far;
    for (const double friction : {0.3, 1.0}) {
      const Rubbed rough = rub(1e5, friction, depth);
      EXPECT_LT(rough.far, friction < 1 ? 2 * smooth : farthest_stuck(smooth))
          << depth << " m deep, friction " << friction;
      EXPECT_LT(rough.change, 0.1) << depth << " m deep, friction " << friction;
    }
  }
}

TEST(RubbedRim, OfStiffTissueThrowsNothing) {
  EXPECT_LT(rub(1e6, 1, 0.003).far, farthest_stuck(rub(1e6, 0, 0.003).far));
}

}  // namespace
}  // namespace palpate
