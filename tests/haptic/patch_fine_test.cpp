// A tip on triangles an eighth of its radius wide: a patch then rests on more nodes than it has squares.
#include <gtest/gtest.h>

#include "bench/touch_block.hpp"
#include "common/contact/patch/hat_kernel.hpp"
#include "common/contact/patch/patch_touch.hpp"
#include "tests/haptic/sphere_on_half_space.hpp"
#include "tests/haptic/synthetic_body.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using bench::kTipRadius;
using Eigen::Vector3d;

constexpr double kEdge = kTipRadius / 8;
constexpr int kNodes = 23;  // a side, which is enough for a tip within two edges of the middle

double exact(double depth) {
  return testing::SphereOnHalfSpace(kTipRadius, bench::kBlockYoung, bench::kBlockPoisson).force(depth);
}

/// The half-space itself among the nodes of a flat square.
Archive half_space() {
  Archive a = testing::flat_patch(kNodes, kEdge, 0);
  a.young = {bench::kBlockYoung};
  a.poisson = {bench::kBlockPoisson};
  const SmoothSurface surface(a.surface);
  const HatKernel kernel(surface, {a.young[0], a.poisson[0]}, std::vector<bool>(a.surface.size(), true));
  std::size_t entry = 0;
  for (int i = 0; i < a.surface.size(); ++i)
    for (int row = 0; row < 3; ++row)
      for (int j = 0; j <= i; ++j) {
        const Eigen::Matrix3d block = kernel.between(i, j);
        for (int column = 0; column < (j < i ? 3 : row + 1); ++column)
          a.touchable_compliance[entry++] = block(row, column);
      }
  return a;
}

class PatchOnFineTriangles : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { archive_ = std::make_unique<Archive>(half_space()); }
  static void TearDownTestSuite() { archive_.reset(); }
  static std::unique_ptr<PressRig> rig(double friction) {
    auto rig = std::make_unique<PressRig>(bench::touch_scene(bench::touch_block(), friction), std::vector{*archive_});
    rig->start(centre(0, -1e-3));
    return rig;
  }
  static Vector3d centre(double along, double depth) {
    return Vector3d(along * kEdge, 0.4 * along * kEdge, kTipRadius - depth);
  }
  /// From above.
  static void press_in(PressRig& rig, double along, double depth) {
    rig.press(centre(along, -1e-3));
    for (int i = 1; i <= 50; ++i) rig.press(centre(along, -1e-3 + (depth + 1e-3) * i / 50));
  }
  /// What the nodes carry.
  struct Carried {
    int nodes = 0;
    Vector3d force = Vector3d::Zero();   ///< [N] on the tissue
    Vector3d middle = Vector3d::Zero();  ///< [m]
  };
  static Carried carried(PressRig& rig) {
    Carried all;
    rig.haptic().part(0)->for_each_force([&](int, int node, const Vector3d& f) {
      ++all.nodes;
      all.force += f;
      all.middle += f.z() * archive_->surface.position[node];
    });
    all.middle /= all.force.z();
    return all;
  }

  static std::unique_ptr<Archive> archive_;
};
std::unique_ptr<Archive> PatchOnFineTriangles::archive_;

TEST_F(PatchOnFineTriangles, TheForceIsExactAndUnderTheTip) {
  const auto rig = PatchOnFineTriangles::rig(0);
  for (const double along : {-1.0, 0.0, 0.3, 0.5})
    for (const double depth : {kTipRadius / 4, kTipRadius / 2}) {
      press_in(*rig, along, depth);
      const double force = -rig->force().z();
      EXPECT_NEAR(force, exact(depth), 0.03 * exact(depth)) << along << " " << depth;
      const Carried by_nodes = carried(*rig);
      EXPECT_LE(by_nodes.nodes, PatchTouch::kMaxForces);
      EXPECT_LT((by_nodes.force - rig->force()).norm(), 1e-12);
      const Vector3d aside = by_nodes.middle - centre(along, depth);
      EXPECT_LT(aside.head<2>().norm(), 0.01 * kTipRadius) << along << " " << depth;
    }
}

TEST_F(PatchOnFineTriangles, ASlideHasNoJumps) {
  for (const double friction : {0.0, 0.3}) {
    const auto rig = PatchOnFineTriangles::rig(friction);
    const double depth = kTipRadius / 2;
    press_in(*rig, -1, depth);
    Vector3d before = rig->force();
    for (int i = 1; i <= 90; ++i) {
      rig->press(centre(-1 + i / 45.0, depth));
      const Vector3d now = rig->force();
      const double allowed = friction == 0 || i > 60 ? 0.003 : 0.01;  // while the shear is built up
      EXPECT_LT((now - before).norm(), allowed * exact(depth)) << friction << " " << i;
      before = now;
    }
  }
}

// Nodes that come towards what presses them, which no tissue does, leave no pressures that solve the contact.
TEST(PatchOnNodesThatPush, SaysThatItsPressuresDoNotSettle) {
  Archive pushing = testing::flat_patch(kNodes, kEdge, -1);
  pushing.young = {bench::kBlockYoung};
  pushing.poisson = {bench::kBlockPoisson};
  PressRig rig(bench::touch_scene(bench::touch_block(), 0), {pushing});
  const auto centre = [](double depth) { return Vector3d(0.3 * kEdge, 0.1 * kEdge, kTipRadius - depth); };
  rig.start(centre(-1e-3));
  int flagged = 0;
  for (int i = 1; i <= 50; ++i) {
    rig.press(centre(-1e-3 + 1e-4 * i));
    EXPECT_TRUE(rig.force().allFinite()) << i;
    flagged += (rig.haptic().flags(0) & regularised) != 0;
  }
  EXPECT_GT(flagged, 0);
}

}  // namespace
}  // namespace palpate
