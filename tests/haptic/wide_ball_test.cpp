// A ball that is wider than what it presses: the wider, the more it presses, up to a flat plate.
#include <gtest/gtest.h>

#include "bench/touch_block.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

/// [N] Of a ball of that radius [m], 1 mm deep in the middle of a block of 30 x 30 x 10 mm.
double force_of_ball(double radius, const Archive& archive) {
  Scene scene = bench::touch_scene(bench::touch_block(), 0);
  std::get<ProbeSpec>(scene.tools[0].end).radius = radius;
  scene.tools[0].pivot.z() = 2 * radius + 0.3;
  PressRig rig(scene, {archive});
  const auto centre = [&](double depth) { return Eigen::Vector3d(0, 0, radius - depth); };
  rig.start(centre(-1e-3));
  for (int i = 1; i <= 100; ++i) rig.press(centre(-1e-3 + 2e-3 * i / 100));
  return -rig.force().z();
}

TEST(WideBall, PressesTheMoreTheWiderItIs) {
  std::vector<double> across, down;
  for (int i = 0; i <= 10; ++i) across.push_back(-0.015 + 0.003 * i);
  for (int i = 0; i <= 4; ++i) down.push_back(-0.01 + 0.0025 * i);
  QuasiStaticSpec block = bench::touch_block();
  block.offline = Offline{};
  const Archive archive = precompute(block, make_graded_block(across, across, down));
  double before = 0;
  for (const double radius : {0.006, 0.012, 0.02, 0.03, 0.05, 0.08, 0.11, 0.2, 1.0, 20.0}) {
    const double force = force_of_ball(radius, archive);
    EXPECT_GT(force, before) << radius;
    before = force;
  }
  // a column whose sides stay free and one that is pressed as a whole, between which a plate's is
  const double area = 0.03 * 0.03, strain = 0.1, nu = bench::kBlockPoisson;
  const double free_sides = bench::kBlockYoung * area * strain;
  EXPECT_GT(before, 0.9 * free_sides);
  EXPECT_LT(before, free_sides * (1 - nu) / ((1 + nu) * (1 - 2 * nu)));
}

}  // namespace
}  // namespace palpate
