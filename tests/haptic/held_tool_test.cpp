// A tool in the hand of a page, which feels nothing: the tool gives way to the force at its tip.
#include <gtest/gtest.h>

#include <cmath>

#include "common/devices/device.hpp"
#include "common/devices/virtual_coupling.hpp"
#include "common/tool/motion_guard.hpp"
#include "tests/haptic/patch_block.hpp"
#include "tools/rig/tip_at.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kSampleApart = 16;  // ticks: sixty samples a second
constexpr double kTop = 0.02;     // [m] where the tip stands above the block

/// The block under a pointer's tool, tick by tick as the haptic loop has it.
class HeldTool : public ::testing::Test {
 protected:
  HeldTool() {
    Tool tool = testing::PatchBlock::probe("probe");
    tool.device = PointerDeviceSpec{.start = {0, 0, kTop}};
    tool.max_force = 10;
    tool.max_force_rate = 250;
    block_.scene.tools.push_back(tool);
    haptic_ = std::make_unique<HapticStep>(block_.scene, std::vector{block_.archive});
    device_ = std::move(make_devices(block_.scene.tools, block_.scene.rates.haptic_hz).front());
    guard_ = std::make_unique<MotionGuard>(haptic_->rig(0).motion_limits(), haptic_->dt());
    haptic_->start(std::array{device_->read(0).dofs});
    tick();
  }

  /// The pointer wants the tip at `target` [m] for so many ticks.
  void lead(const Vector3d& target, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      if (i % kSampleApart == 0) device_->put({tip_at(block_.scene.tools[0], target), ++seq_});
      tick();
    }
  }
  void be_silent(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }
  Vector3d force() const { return haptic_->force(0); }
  Vector3d tip() const { return haptic_->pose(0).translation(); }

  double most_ = 0, jump_ = 0, deepest_ = -1;  ///< [N], [N] in a tick, [m] below the block's top

 private:
  void tick() {
    const DeviceSample sample = device_->read(haptic_->dt() * ++ticks_);
    const Vector3d before = force();
    haptic_->step(std::array{guard_->follow(sample.dofs, sample.seq)});
    device_->render({haptic_->force(0), haptic_->torque(0)}, 0);
    most_ = std::max(most_, force().norm());
    jump_ = std::max(jump_, (force() - before).norm());
    deepest_ = std::max(deepest_, -tip().z());
  }

  testing::PatchBlock block_{0};
  std::unique_ptr<HapticStep> haptic_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<MotionGuard> guard_;
  std::uint64_t seq_ = 0;
  int ticks_ = 0;
};

TEST_F(HeldTool, IsNotDraggedThroughTheOrganAndComesBack) {
  lead({0, 0, -0.06}, 2500);
  EXPECT_LT(-tip().z(), 0.03) << "[m] where the pointer is 60 mm deep";
  EXPECT_NEAR(force().norm(), VirtualCoupling::kStrength, 0.02);
  lead({0.03, 0, -0.06}, 2150);
  EXPECT_LT(tip().x(), 0.025) << "friction holds it back";
  EXPECT_NEAR(force().norm(), VirtualCoupling::kStrength, 0.02);
  EXPECT_LT(most_, 3) << "the damper pulls as well while the pointer moves";
  EXPECT_LT(jump_, 0.02);
  lead({0.03, 0, kTop}, 900);
  EXPECT_EQ(force().norm(), 0);
  EXPECT_LT((tip() - Vector3d(0.03, 0, kTop)).norm(), 1e-6);
  EXPECT_LT(jump_, 0.02);
}

TEST_F(HeldTool, StandsWhileItsHandIsGoneAndAsTheForceReturns) {
  lead({0, 0, -0.01}, 600);
  const Vector3d rest = tip();
  ASSERT_GT(rest.z(), -0.0095) << "it gives way";
  deepest_ = -rest.z();
  be_silent(400);
  EXPECT_EQ(force().norm(), 0);
  EXPECT_LT((tip() - rest).norm(), 1e-4);
  lead({0, 0, -0.01}, 300);
  EXPECT_LT((tip() - rest).norm(), 1e-4);
  EXPECT_LT(deepest_, -rest.z() + 3e-4);
}

/// Where the tip comes to rest that is led 10 mm into tissue of that stiffness [N/m], whose force comes a tick late.
TEST(VirtualCoupling, RestsAgainstSoftAndStiffTissue) {
  constexpr double kLed = 0.01, kDt = 1e-3;
  for (const double tissue : {10.0, 100.0, 1000.0, 0.9 * VirtualCoupling::kStiffestTissue}) {
    VirtualCoupling coupling;
    double tip = kLed, force = 0, swing = 0;
    for (int i = 0; i < 3000; ++i) {
      const double before = tip;
      tip = kLed + coupling.step({force, 0, 0}, {0, 0, 0}, kDt).x();
      force = -tissue * std::max(tip, 0.0);
      if (i > 2000) swing = std::max(swing, std::abs(tip - before));
    }
    const double pull = std::min(VirtualCoupling::kStiffness * (kLed - tip), VirtualCoupling::kStrength);
    EXPECT_NEAR(-force, pull, 1e-6) << tissue;
    EXPECT_LT(swing, 1e-9) << tissue;
  }
}

TEST(VirtualCoupling, IsNotThereWhereNothingIsMet) {
  VirtualCoupling coupling;
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(coupling.step({0, 0, 0}, {0, 0, 0}, 1e-3).isZero(0));
  for (int i = 0; i < 100; ++i)
    EXPECT_LT(coupling.step({0.3, 0, 0}, {0, 0, 0}, 1e-3).x(), 0.3 / VirtualCoupling::kStiffness * 1.001);
  for (int i = 0; i < 1000; ++i) coupling.step({0, 0, 0}, {0, 0, 0}, 1e-3);
  EXPECT_TRUE(coupling.step({0, 0, 0}, {0, 0, 0}, 1e-3).isZero(0));
}

}  // namespace
}  // namespace palpate
