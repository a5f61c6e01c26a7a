// What is shown of the dent under a tip whose triangles are twice as long as its radius.
#include <gtest/gtest.h>

#include "common/archive/compliance.hpp"
#include "common/bus/codec.hpp"
#include "common/contact/patch/patch_touch.hpp"
#include "tests/haptic/patch_block.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::PatchBlock;

class DentUnderATip : public ::testing::Test {
 protected:
  static constexpr double kRadius = PatchBlock::kRadius;
  static void SetUpTestSuite() { block_ = std::make_unique<PatchBlock>(0); }
  static void TearDownTestSuite() { block_.reset(); }

  /// A tip that is pressed half its radius deep at a place of the top.
  static std::unique_ptr<PressRig> pressed(const Vector3d& place) {
    Scene scene = block_->scene;
    scene.contact.friction = 0;
    scene.tools.push_back(PatchBlock::probe("probe"));
    auto rig = std::make_unique<PressRig>(scene, std::vector{block_->archive});
    rig->start(place + (kRadius + 1e-3) * Vector3d::UnitZ());
    for (int i = 1; i <= 50; ++i)
      rig->step(place + (kRadius + 1e-3 - (kRadius / 2 + 1e-3) * i / 50) * Vector3d::UnitZ());
    return rig;
  }
  static const SurfaceMap& surface() { return block_->archive.surface; }

  static std::unique_ptr<PatchBlock> block_;
};
std::unique_ptr<PatchBlock> DentUnderATip::block_;

// The mean over a hat, which is what the tensors know, does not come so far down.
TEST_F(DentUnderATip, ShowsANodeAtTheTipsBottom) {
  const auto rig = pressed(Vector3d::Zero());
  const auto nearest = std::ranges::min_element(surface().position, {}, [](const Vector3d& p) { return p.norm(); });
  const auto middle = nearest - surface().position.begin();
  EXPECT_NEAR(rig->displacement()[middle].z(), -kRadius / 2, 0.05 * kRadius / 2);
  const Compliance<double> compliance(block_->archive, Compliance<double>::Rows::touchable);
  double mean = 0;
  rig->haptic().part(0)->for_each_force([&](int, int node, const Vector3d& f) {
    for (int axis = 0; axis < 3; ++axis) mean += compliance.column(node, axis)[3 * middle + 2] * f[axis];
  });
  EXPECT_GT(mean, -0.75 * kRadius / 2) << mean;
}

// Beside the contact: the half-space's own answer by Hertz, and what the block's base takes off it, some hundredths.
TEST_F(DentUnderATip, ShowsNodesBesideItWhereTheTissueIs) {
  for (const Vector3d& place : {Vector3d(0, 0, 0), Vector3d(0.003, 0.001, 0), Vector3d(0.006, 0.006, 0)}) {
    const auto rig = pressed(place);
    const std::vector<Vector3d> u = rig->displacement();
    const HalfSpace tissue{PatchBlock::kYoung, PatchBlock::kPoisson};
    const HertzDent dent{
        place, Vector3d::UnitZ(), rig->force(), HertzDent::disc_under(kRadius, -rig->force().z(), tissue), 1, tissue};
    const double deepest = -dent.field(place, Vector3d::UnitZ()).z();
    for (int n = 0; n < surface().size(); ++n) {
      const Vector3d& at = surface().position[n];
      if (at.z() < -1e-9 || (at - place).norm() > 4 * kRadius) continue;
      EXPECT_NEAR(u[n].z(), dent.field(at, Vector3d::UnitZ()).z(), 0.08 * deepest) << at.transpose();
    }
  }
}

TEST_F(DentUnderATip, GoesWithTheTip) {
  const auto rig = pressed(Vector3d::Zero());
  for (int i = 0; i < 20; ++i) rig->step((kRadius + 1e-3) * Vector3d::UnitZ());
  for (const Vector3d& u : rig->displacement()) EXPECT_EQ(u, Vector3d::Zero());
}

// A tip loads as many nodes as a patch may, a shaft three for each of its strip's feet.
TEST(ContactStateSize, OfATipAndAShaftThatTouchStaysBelowFourKilobytes) {
  ContactState state;
  const PatchGrid shaft(0.002, 0.1, HalfSpace{6000, 0.3});
  state.forces.resize(PatchTouch::kMaxForces + 3 * shaft.feet());
  state.contacts.resize(2);
  Bytes bytes;
  encode(state, bytes);
  EXPECT_LE(bytes.size(), 4000u);
}

}  // namespace
}  // namespace palpate
