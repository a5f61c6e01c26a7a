// The patch rule under a shaft: what a hand feels that lays a probe on an organ, whatever its triangles.
#include <gtest/gtest.h>

#include "bench/shaft_block.hpp"
#include "tests/tool/count_allocations.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using bench::kShaftRadius;
using bench::shaft_tip;
using Eigen::Vector3d;

/// [N] that nodes on edges of half and a quarter of the radius converge to (bench_shaft, rows reference).
struct Converged {
  double depth, force;
};
constexpr Converged kConverged[] = {{0.25 * kShaftRadius, 0.314}, {0.5 * kShaftRadius, 0.715}};

class ShaftOnEdges : public ::testing::TestWithParam<double> {
 protected:
  static double edge() { return kShaftRadius / GetParam(); }
  static PressRig rig(double friction, const char* rule = "patch") {
    const QuasiStaticSpec block = bench::shaft_block();
    return {bench::shaft_scene(block, rule, friction), {precompute(block, bench::shaft_block_of_edges(edge()))}};
  }
};

TEST_P(ShaftOnEdges, TheForceIsThatOfAConvergedMeshWhereverItLies) {
  PressRig rig = ShaftOnEdges::rig(0);
  rig.start(shaft_tip(0, 0, -1e-3));
  for (const double share : {0.0, 0.2, 0.4, 0.6})
    for (const auto& [depth, converged] : kConverged) {
      for (int i = 0; i <= 50; ++i) rig.press(shaft_tip(share * edge(), 0, -1e-3 + (depth + 1e-3) * i / 50));
      EXPECT_NEAR(-rig.force().z(), converged, 0.03 * converged) << share << " " << depth;
    }
}

// By the mesh's points the force changes by up to a fifth of itself in a tick.
TEST_P(ShaftOnEdges, NeitherPressingNorHoldingNorSlidingNorLeavingBuzzes) {
  for (const double friction : {0.0, 0.3}) {
    PressRig rig = ShaftOnEdges::rig(friction);
    rig.start(shaft_tip(0, 0, -1e-3));
    const double most = kConverged[1].force;
    double before = 0;
    const auto step = [&](double aside, double along, double depth, double allowed) {
      rig.press(shaft_tip(aside, along, depth));
      const double now = rig.force().norm();
      EXPECT_LT(std::abs(now - before), allowed * most) << aside << " " << along << " " << depth;
      before = now;
    };
    const auto ramp = [](int i) { return -1e-3 + (kShaftRadius / 2 + 1e-3) * i / 100; };
    for (int i = 1; i <= 100; ++i) step(0, 0, ramp(i), 0.02);
    for (int i = 0; i < 20; ++i) step(0, 0, kShaftRadius / 2, 0.002);
    for (int i = 0; i < 5; ++i) step(0, 0, kShaftRadius / 2, 1e-6);
    for (int i = 1; i <= 200; ++i) step(5e-5 * i, 0, kShaftRadius / 2, 0.002);
    for (int i = 1; i <= 200; ++i) step(0.01, 5e-5 * i, kShaftRadius / 2, 0.003);
    for (int i = 99; i >= 0; --i) step(0.01, 0.01, ramp(i), 0.02);
    EXPECT_EQ(before, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(RadiusOverEdge, ShaftOnEdges, ::testing::Values(0.5, 1.0));

/// A probe whose tip lies on the block's top and whose shaft sinks from steep to level about it.
class LaidDown : public ::testing::Test {
 protected:
  static constexpr double kPivot = 0.3;  // [m] from the tip
  static void SetUpTestSuite() {
    archive_ = precompute(bench::shaft_block(), bench::shaft_block_of_edges(2 * kShaftRadius));
  }
  static Archive archive_;

  static Scene scene(double tip_radius, double shaft_radius) {
    Scene scene = bench::shaft_scene(bench::shaft_block(), "patch", 0.3);
    Tool& tool = scene.tools[0];
    std::get<ProbeSpec>(tool.end).radius = tip_radius;
    tool.shaft_radius = shaft_radius;
    tool.shaft_length = 0.2;
    return scene;
  }
};
Archive LaidDown::archive_;

// A level pivot that sinks is a tip that is pressed in by a shaft that turns about it: the tool is moved so that the
// shaft comes down as the tip stays.
TEST_F(LaidDown, TipAndShaftGoOverIntoOneAnother) {
  for (const auto& [tip_radius, shaft_radius] : {std::pair{0.004, 0.002}, {0.006, 0.006}, {0.006, 0.0025}}) {
    Scene scene = LaidDown::scene(tip_radius, shaft_radius);
    // The pivot is 0.1 m beside the block and 0.12 above: the shaft turns from 40 to 0 degrees as the tip moves away.
    double before = 0, peak = 0, worst = 0;
    int worst_at = 0;
    std::optional<PressRig> rig;
    scene.tools[0].pivot = {-0.15, 0, 0.004};
    scene.tools[0].axis = Vector3d::UnitX();
    rig.emplace(scene, std::vector<Archive>{archive_});
    const auto tip = [&](int i) { return Vector3d(0.02, 0.001, tip_radius + 0.003 - 0.00002 * i); };
    rig->start(tip(0));
    for (int i = 0; i < 500; ++i) {
      rig->press(tip(i));
      const double now = rig->force().norm();
      const double change = std::abs(now - before);
      if (change > worst) worst = change, worst_at = i;
      peak = std::max(peak, now);
      before = now;
      if (i % 25 == 0) {
        std::string parts;
        rig->haptic().part(0)->for_each_contact([&](const TouchContact& c) {
          parts += std::to_string(c.tool_point().part) + ":" + std::to_string(c.force.norm()) + " ";
        });
        std::printf("%d %.5f %s\n", i, now, parts.c_str());
      }
    }
    std::printf("tip %g shaft %g: peak %g, worst %g at %d\n", tip_radius, shaft_radius, peak, worst, worst_at);
    EXPECT_LT(worst, 0.01 * peak);
  }
}

}  // namespace
}  // namespace palpate
