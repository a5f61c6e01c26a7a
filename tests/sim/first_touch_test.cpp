// Moving tissue that a tool has just come to is felt by the haptic node before the deformation node knows of it. What a
// hand feels then goes over into what the tissue answers, from no force on and without a fall.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tools/rig/example_bodies.hpp"
#include "tools/rig/kinds.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kTouchedTop = 0.03, kTipRadius = 0.006;  // [m]
constexpr double kLevel = 0.2;                            // [rad] of a shaft that lies nearly level

/// What a hand feels from the first touch on.
struct FirstRise {
  double force = 0;  ///< [N] at its end
  double fall = 0;   ///< [N] at most below what was felt before
  double step = 0;   ///< [N] from one tick to the next at most
  double slope = 0;  ///< [N] that a tick brings in the mean

  void feel(double now) {
    most_ = std::max(most_, now);
    fall = std::max(fall, most_ - now);
    step = std::max(step, std::abs(now - force));
    force = now;
  }

 private:
  double most_ = 0;
};

/// The tip comes down on a block of so many cells at `speed` [m/s], until it is a third of its radius deep.
FirstRise come_down(int cells, const Vector3d& place, double speed) {
  Scene scene = moving_block_scene(TensorMassSpec{}, 0.3);
  std::get<ProbeSpec>(scene.tools[0].end).radius = kTipRadius;
  PressRig rig(scene, {precompute_on(scene.bodies[0], middle_block_mesh(cells))});
  const double above = kTouchedTop + kTipRadius;
  rig.start(Vector3d(place + Vector3d(0, 0, above + 0.001)));
  FirstRise rise;
  for (double way = -0.001; way < kTipRadius / 3; way += speed * rig.dt()) {
    rig.step(Vector3d(place + Vector3d(0, 0, above - way)));
    rise.feel(rig.haptic().force(0).z());
  }
  rise.slope = rise.force * speed * rig.dt() / (kTipRadius / 3);
  return rise;
}

TEST(FirstTouch, OfATipRisesWithoutAFallWhereverItComesDown) {
  for (const int cells : {6, 12})
    for (const Vector3d& place : {Vector3d(0, 0, 0), Vector3d(0.005, 0.0012, 0), Vector3d(0.0033, 0.0062, 0)})
      for (const double speed : {0.01, 0.05}) {
        const FirstRise rise = come_down(cells, place, speed);
        fmt::print(
            "{} cells, at {:.4f} {:.4f}, {} m/s: {:.2f} mN in the end, falls by {:.3f} mN, by {:.3f} mN a tick\n",
            cells, place.x(), place.y(), speed, 1e3 * rise.force, 1e3 * rise.fall, 1e3 * rise.step);
        EXPECT_GT(rise.force, 0.01);
        EXPECT_LT(rise.fall, 0.01 * rise.force);
        EXPECT_LT(rise.step, 2.5 * rise.slope);
      }
}

// A tool that lies nearly level: its shaft comes to where the tip's dent is, which the mesh does not show, and is named
// by the model as soon as it presses.
TEST(FirstTouch, OfAShaftBesideItsTipIsFeltOnce) {
  Scene scene = moving_block_scene(TensorMassSpec{}, 0.3);
  Tool& tool = scene.tools[0];
  std::get<ProbeSpec>(tool.end).radius = 0.003;
  tool.axis = Vector3d(std::cos(kLevel), 0, -std::sin(kLevel));
  tool.pivot = Vector3d(0, 0, kTouchedTop) - 0.15 * tool.axis;
  for (const int cells : {6, 12}) {
    PressRig rig(scene, {precompute_on(scene.bodies[0], middle_block_mesh(cells))});
    const double above = kTouchedTop + 0.003, speed = 0.01;
    rig.start(Vector3d(0.005, 0.0012, above + 0.001));
    FirstRise rise;
    for (double way = -0.001; way < 0.004; way += speed * rig.dt()) {
      rig.step(Vector3d(0.005, 0.0012, above - way));
      rise.feel(rig.haptic().force(0).norm());
    }
    rise.slope = rise.force * speed * rig.dt() / 0.004;
    fmt::print("{} cells: {:.2f} mN in the end, falls by {:.3f} mN, by {:.3f} mN a tick, {:.3f} in the mean\n", cells,
               1e3 * rise.force, 1e3 * rise.fall, 1e3 * rise.step, 1e3 * rise.slope);
    EXPECT_LT(rise.fall, 0.01 * rise.force);
    EXPECT_LT(rise.step, 5 * rise.slope);
  }
}

}  // namespace
}  // namespace palpate
