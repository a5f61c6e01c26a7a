// The patch rule on tensors of linear elements, from triangles of twice the tip's radius to a quarter of it: the force
// is the tissue's, wherever on a triangle the tip stands.
#include <gtest/gtest.h>

#include "bench/touch_block.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using bench::hertz;
using bench::kTipRadius;
using Eigen::Vector3d;

/// [1] The converged force over Hertz's on that block (bench_touch, rows hertz_reference), by depth in radii.
struct Converged {
  double depth, share;
};
constexpr Converged kConverged[] = {{0.25, 1.070}, {0.5, 1.037}};

class PatchOnEdges : public ::testing::TestWithParam<double> {
 protected:
  static double edge() { return kTipRadius / GetParam(); }
  static PressRig rig() {
    QuasiStaticSpec block = bench::touch_block();
    block.offline = Offline{};
    const double reach = 1.3 * kTipRadius + 2 * edge();
    block.touchable =
        NodeSelector{{.indices = {}, .box = Box{{-reach, -reach, -1e-6}, {reach, reach, 1}}, .group = {}}};
    return {bench::touch_scene(block, 0), {precompute(block, bench::block_of_edges(edge()))}};
  }
  static Vector3d centre(const Vector3d& place, double depth) { return place + Vector3d(0, 0, kTipRadius - depth); }
};

TEST_P(PatchOnEdges, TheForceIsThatOfAConvergedMesh) {
  PressRig rig = PatchOnEdges::rig();
  bool first = true;
  for (const auto& share : {Vector3d(0, 0, 0), Vector3d(0.25, 0.1, 0), Vector3d(0.5, 0.25, 0), Vector3d(0.5, 0.5, 0)})
    for (const auto& [depth, converged] : kConverged) {
      const Vector3d place = edge() * share;
      if (first) rig.start(centre(place, -1e-3));
      first = false;
      rig.press(centre(place, -1e-3));
      for (int i = 1; i <= 50; ++i) rig.press(centre(place, -1e-3 + (depth * kTipRadius + 1e-3) * i / 50));
      EXPECT_NEAR(-rig.force().z() / hertz(depth * kTipRadius), converged, 0.03 * converged)
          << share.transpose() << " " << depth;
    }
}

TEST_P(PatchOnEdges, NeitherPressingNorHoldingNorSlidingNorLeavingBuzzes) {
  PressRig rig = PatchOnEdges::rig();
  rig.start(centre(Vector3d::Zero(), -1e-3));
  double before = 0;
  const double most = 1.05 * hertz(kTipRadius / 2);
  const auto step = [&](const Vector3d& at, double depth, double allowed) {
    rig.press(centre(at, depth));
    const double now = -rig.force().z();
    EXPECT_GE(now, 0);
    EXPECT_LT(std::abs(now - before), allowed * most) << at.transpose() << " " << depth;
    before = now;
  };
  const auto ramp = [](int i) { return -1e-3 + (kTipRadius / 2 + 1e-3) * i / 200; };
  const Vector3d way = edge() * Vector3d(1, 0.5, 0);
  for (int i = 1; i <= 200; ++i) step(Vector3d::Zero(), ramp(i), 0.015);
  for (int i = 0; i < 20; ++i) step(Vector3d::Zero(), kTipRadius / 2, 1e-9);
  for (int i = 1; i <= 400; ++i) step(way * i / 400, kTipRadius / 2, 0.001);
  for (int i = 199; i >= 0; --i) step(way, ramp(i), 0.015);
  EXPECT_EQ(before, 0);
}

// On the finest edges it takes ten times as long as on all others.
std::vector<double> radius_over_edge() {
  std::vector<double> all{0.5, 1.0, 2.0, 3.0};
  if (std::getenv("PALPATE_LONG_TESTS")) all.push_back(4.0);
  return all;
}

INSTANTIATE_TEST_SUITE_P(RadiusOverEdge, PatchOnEdges, ::testing::ValuesIn(radius_over_edge()));

}  // namespace
}  // namespace palpate
