// The patch rule under a shaft: what a hand feels that lays a probe on an organ, whatever its triangles.
#include <gtest/gtest.h>

#include "bench/shaft_block.hpp"
#include "common/contact/patch/patch_grid.hpp"
#include "tests/tool/count_allocations.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using bench::kShaftRadius;
using bench::shaft_tip;
using Eigen::Vector3d;

/// [N] by the mesh's points on edges of a quarter of the radius; half the radius gives 1 % less and 3 % more
/// (bench_shaft, rows reference).
struct Converged {
  double depth, force;
};
constexpr Converged kConverged[] = {{0.25 * kShaftRadius, 0.317}, {0.5 * kShaftRadius, 0.696}};

class ShaftOnEdges : public ::testing::TestWithParam<double> {
 protected:
  static double edge() { return kShaftRadius / GetParam(); }
  static PressRig rig(double friction, ContactRule rule = ContactRule::patch) {
    const QuasiStaticSpec block = bench::shaft_block();
    return {bench::shaft_scene(block, rule, friction), {precompute(block, bench::shaft_block_of_edges(edge()))}};
  }
  /// [N] down at places of a triangle, over the converged force.
  static std::vector<double> shares(PressRig& rig) {
    std::vector<double> all;
    rig.start(shaft_tip(0, 0, -1e-3));
    for (const double share : {0.0, 0.2, 0.4, 0.6})
      for (const auto& [depth, converged] : kConverged) {
        for (int i = 0; i <= 50; ++i) rig.press(shaft_tip(share * edge(), 0, -1e-3 + (depth + 1e-3) * i / 50));
        all.push_back(-rig.force().z() / converged);
      }
    return all;
  }
};

TEST_P(ShaftOnEdges, TheForceIsThatOfAConvergedMeshWhereverItLies) {
  PressRig rig = ShaftOnEdges::rig(0);
  for (const double share : shares(rig)) EXPECT_NEAR(share, 1, 0.04);
}

TEST_P(ShaftOnEdges, ByTheMeshItIsTheMeshs) {
  PressRig rig = ShaftOnEdges::rig(0, ContactRule::barycentric);
  EXPECT_GT(std::ranges::max(shares(rig)), 1.3);
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
    for (int i = 1; i <= 200; ++i) step(5e-5 * i, 0, kShaftRadius / 2, 0.004);
    for (int i = 1; i <= 200; ++i) step(0.01, 5e-5 * i, kShaftRadius / 2, 0.004);
    for (int i = 99; i >= 0; --i) step(0.01, 0.01, ramp(i), 0.02);
    EXPECT_EQ(before, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(RadiusOverEdge, ShaftOnEdges, ::testing::Values(0.5, 1.0));

/// The block on edges of two radii, all of its top to be touched, under a probe with a shaft.
class ProbeWithShaft : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    archive_ = precompute(block(), bench::shaft_block_of_edges(2 * kShaftRadius, bench::kShaftBlockHalf));
  }
  static void TearDownTestSuite() { archive_ = {}; }
  static QuasiStaticSpec block() { return bench::shaft_block(bench::kShaftBlockHalf); }
  static Scene scene(double tip_radius, double shaft_radius) {
    Scene scene = bench::shaft_scene(block(), ContactRule::patch, 0.3);
    Tool& tool = scene.tools[0];
    std::get<ProbeSpec>(tool.end).radius = tip_radius;
    tool.shaft_radius = shaft_radius;
    tool.shaft_length = 0.2;
    return scene;
  }
  static PressRig rig(const Scene& scene) { return {scene, {archive_}}; }
  /// [N] of a part's contacts.
  static double force_of(PressRig& rig, int part) {
    double sum = 0;
    rig.haptic().part(0)->for_each_contact([&](const TouchContact& c) {
      if (c.tool_point().part == part) sum += c.force.norm();
    });
    return sum;
  }

  static Archive archive_;
};
Archive ProbeWithShaft::archive_;

TEST_F(ProbeWithShaft, GoesOverFromTipToShaftWithoutAJump) {
  for (const auto& [tip_radius, shaft_radius] : {std::pair{0.004, 0.002}, {0.006, 0.006}, {0.006, 0.0025}}) {
    Scene laid = scene(tip_radius, shaft_radius);
    laid.tools[0].pivot = {-0.15, 0, 0.004};  // the shaft turns with the tip's way down
    PressRig rig = ProbeWithShaft::rig(laid);
    const auto tip = [&](int i) { return Vector3d(0.02, 0.001, tip_radius + 0.003 - 2e-5 * i); };
    rig.start(tip(0));
    double before = 0, largest = 0;
    for (int i = 0; i < 1000; ++i) {
      rig.press(tip(i < 500 ? i : 1000 - i));
      const double now = rig.force().norm();
      largest = std::max(largest, std::abs(now - before));
      before = now;
      if (i != 499) continue;
      EXPECT_GT(force_of(rig, 0), 0.1);
      EXPECT_GT(force_of(rig, 1), 0.1);
    }
    EXPECT_LT(largest, 0.008) << tip_radius << " " << shaft_radius;
    EXPECT_EQ(before, 0);
  }
}

// The mesh does not show the tip's dent, in which the shaft stands free; the patches know of one another.
TEST_F(ProbeWithShaft, AnUprightShaftStandsFreeInTheDentOfItsTip) {
  Scene upright = scene(kShaftRadius, 0.5 * kShaftRadius);
  upright.tools[0].pivot = {0, 0, 0.3};
  upright.tools[0].axis = -Vector3d::UnitZ();
  upright.tools[0].up = Vector3d::UnitY();
  PressRig rig = ProbeWithShaft::rig(upright);
  const auto tip = [&](int i) { return Vector3d(0.004, 0.003, kShaftRadius + 0.001 - 2e-5 * i); };
  rig.start(tip(0));
  for (int i = 1; i <= 520; ++i) {
    rig.press(tip(i));
    EXPECT_EQ(force_of(rig, 1), 0) << i;
  }
  EXPECT_GT(force_of(rig, 0), 0.5);
}

TEST_F(ProbeWithShaft, ComesOverAnEdgeWithoutAJump) {
  PressRig rig = ProbeWithShaft::rig(scene(kShaftRadius, kShaftRadius));
  const double half = bench::kShaftBlockHalf;
  rig.start(shaft_tip(0, 0, -1e-3));
  double before = 0, largest = 0, peak = 0;
  for (int i = 0; i <= 1400; ++i) {
    const double depth = std::min(-1e-3 + 2e-5 * i, kShaftRadius / 4);
    rig.press(shaft_tip(std::max(0.0, 5e-5 * (i - 200)) * (half + 2 * kShaftRadius) / 0.06, 0, depth));
    const double now = rig.force().norm();
    largest = std::max(largest, std::abs(now - before));
    peak = std::max(peak, now);
    before = now;
  }
  EXPECT_LT(largest, 0.03 * peak);
  EXPECT_EQ(before, 0);
}

class LaidProbe : public ProbeWithShaft {
 protected:
  static Vector3d tip(int i) { return {0.02 + 1e-5 * i, 5e-6 * i, 0.0015 + 0.002 * std::cos(0.02 * i)}; }
  static PressRig rig() { return ProbeWithShaft::rig(scene(0.004, 0.002)); }
  static void press(PressRig& rig) {
    rig.start(Vector3d(tip(0) + Vector3d(0, 0, 0.01)));
    for (int i = 0; i < 150; ++i) rig.step(tip(i));
  }
};

TEST_F(LaidProbe, GoesOnBitForBitFromASavedState) {
  PressRig rig = LaidProbe::rig(), other = LaidProbe::rig();
  press(rig);
  other.start(Vector3d(tip(0) + Vector3d(0, 0, 0.01)));
  other.simulator().restore(rig.simulator().save());
  EXPECT_GT(force_of(rig, 0), 0);
  EXPECT_GT(force_of(rig, 1), 0);
  for (int i = 150; i < 300; ++i) {
    rig.step(tip(i));
    other.step(tip(i));
    ASSERT_EQ(rig.simulator().hash(), other.simulator().hash()) << i;
  }
}

TEST_F(LaidProbe, TakesNoMemoryInAStep) {
  PressRig rig = LaidProbe::rig();
  press(rig);
  const auto dofs = [&](int i) { return std::array{tip_at(rig.scene().tools[0], tip(i))}; };
  const auto before = allocations();
  for (int i = 150; i < 300; ++i) rig.haptic().step(dofs(i));
  EXPECT_EQ(allocations(), before);
}

TEST(PatchKernelTest, ARectangleIsAsManySquares) {
  const HalfSpace tissue{6000, 0.3};
  const PatchGrid strip(0.004, 0.1, tissue);
  const double edge = strip.edge();
  PatchKernel kernel(strip);
  kernel.lay(2 * edge);
  for (int p = 0; p < strip.size(); p += 5)
    for (int q = 0; q < strip.size(); q += 3) {
      const double x = 2 * edge * (strip.column(p) - strip.column(q)), y = edge * (strip.row(p) - strip.row(q));
      double pressed = 0;
      Eigen::Matrix2d sheared = Eigen::Matrix2d::Zero();
      for (const double half : {-0.5, 0.5}) {
        pressed += tissue.pressed(x + half * edge, y, edge) / (2 * edge * edge);
        sheared += tissue.sheared(x + half * edge, y, edge) / (2 * edge * edge);
      }
      const double* const from_q = kernel.pressed(std::abs(strip.column(p) - strip.column(q)), strip.row(q));
      EXPECT_NEAR(from_q[strip.row(p)], pressed, 1e-9 * kernel.own());
      EXPECT_LT((kernel.sheared(p, q) - sheared).norm(), 1e-9 * kernel.own());
    }
}

}  // namespace
}  // namespace palpate
