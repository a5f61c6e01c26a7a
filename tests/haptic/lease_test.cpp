#include <gtest/gtest.h>

#include <cmath>

#include "common/devices/device.hpp"
#include "common/devices/held_device.hpp"
#include "tests/haptic/block_scene.hpp"
#include "tests/haptic/device_scene.hpp"

namespace palpate {
namespace {

constexpr double kDt = 1e-3;

using testing::device_with;

/// A driver that presses at 1 kHz or as a page does, and stops and goes on.
struct Driver {
  explicit Driver(const DeviceSpec& spec) : device(device_with(spec)) {}
  DeviceSample tick(bool speaks, double depth) {
    if (speaks) device->put({{.depth = depth, .pedal = 1}, ++seq});
    return device->read(kDt * ++ticks);
  }
  std::unique_ptr<Device> device;
  std::uint64_t seq = 0;
  int ticks = 0;
};

TEST(Lease, ASilentDriversToolStandsAndIsFlagged) {
  Driver driver(BusDeviceSpec{});
  for (int i = 0; i < 200; ++i) EXPECT_FALSE(driver.tick(true, 0.1 + 1e-5 * i).dofs.silent);
  DeviceSample sample;
  int silent_after = 0;
  for (int i = 0; i < 500; ++i) {
    sample = driver.tick(false, 0);
    if (!sample.dofs.silent) ++silent_after;
  }
  EXPECT_NEAR(silent_after, 100, 2) << "[ms] of the lease";
  EXPECT_DOUBLE_EQ(sample.dofs.depth, 0.1 + 1e-5 * 199);
  EXPECT_EQ(sample.dofs.pedal, 0);
}

TEST(Lease, ADriverThatComesBackElsewhereIsReachedAtAHandsPaceWithoutForce) {
  Driver driver(BusDeviceSpec{.lease = 0.05});
  for (int i = 0; i < 50; ++i) driver.tick(true, 0.1);
  for (int i = 0; i < 200; ++i) driver.tick(false, 0);
  double last = 0.1;
  int silent = 0;
  for (int i = 0; i < 400; ++i) {
    const DeviceSample sample = driver.tick(true, 0.13);
    EXPECT_LE(std::abs(sample.dofs.depth - last), sample.dofs.silent ? 0.25e-3 + 1e-9 : 0.0031) << i;
    last = sample.dofs.depth;
    silent += sample.dofs.silent;
  }
  EXPECT_EQ(last, 0.13);
  EXPECT_GT(silent, 90) << "[ms] for 30 mm";
  EXPECT_LT(silent, 160);
}

/// A device with motors, and what they were told.
struct MotorDevice : Device {
  DeviceSample read(double) override { return {}; }
  void render(const Wrench& wrench, double) override { told = wrench.force.z(); }
  bool finished(double) const override { return false; }
  double told = 0;
};

TEST(Lease, ADeviceUnderAHandGetsItsForceUntilTheHandTakesTheTool) {
  auto owned = std::make_unique<MotorDevice>();
  const MotorDevice& motors = *owned;
  const Tool tool;
  HeldDevice held({}, {tool, 0, 1 / kDt}, std::move(owned));
  held.read(kDt);
  held.render({{0, 0, 1.5}, {0, 0, 0}}, 0);
  EXPECT_EQ(motors.told, 1.5);
  held.put({{.depth = 0.1}, 1});
  held.read(2 * kDt);
  held.render({{0, 0, 0.5}, {0, 0, 0}}, 0);
  EXPECT_EQ(motors.told, 1.5) << "another hand feels it now";
}

TEST(Lease, AHeldToolNeitherJumpsWhenItIsTakenNorWhenItsHandComesBack) {
  Driver driver(PointerDeviceSpec{.start = {0, 0, -0.1}});
  const double start = driver.tick(false, 0).dofs.depth;
  double last = start;
  bool was_silent = false;
  for (int i = 0; i < 1500; ++i) {
    const bool speaks = i % 16 == 0 && (i < 400 || i > 900) && i > 50;
    const DeviceSample sample = driver.tick(speaks, i < 600 ? start + 0.04 : start - 0.05);
    EXPECT_LE(std::abs(sample.dofs.depth - last), 0.25e-3 + 1e-9) << i;
    last = sample.dofs.depth;
    was_silent |= sample.dofs.silent;
    EXPECT_FALSE(i < 50 && sample.dofs.silent) << "nobody has taken it yet";
  }
  EXPECT_TRUE(was_silent);
  EXPECT_NEAR(last, start - 0.05, 1e-6);
}

/// The force on a tool that stands pressed into a block.
TEST(LeaseOnForce, FadesIn20MillisecondsAndComesBackIn50WithoutAJump) {
  const testing::BlockScene s;
  HapticStep haptic(s.scene, s.archives);
  const auto at = [&](double height, bool silent) {
    ToolDofs dofs = tip_at(s.scene.tools[0], {0, 0, height});
    dofs.silent = silent;
    return std::array{dofs};
  };
  const double above = 0.02, pressed = 0.003;
  haptic.start(at(above, false));
  for (int i = 0; i < 400; ++i) haptic.step(at(above + (pressed - above) * i / 400, false));
  for (int i = 0; i < 100; ++i) haptic.step(at(pressed, false));
  const double full = haptic.force(0).norm();
  ASSERT_GT(full, 0.01);
  EXPECT_EQ(haptic.flags(0) & silent_device, 0u);
  for (int i = 0; i < 21; ++i) haptic.step(at(pressed, true));
  EXPECT_EQ(haptic.force(0).norm(), 0);
  EXPECT_NE(haptic.flags(0) & silent_device, 0u);
  double last = 0, jump = 0;
  for (int i = 0; i < 60; ++i) {
    haptic.step(at(pressed, false));
    jump = std::max(jump, haptic.force(0).norm() - last);
    last = haptic.force(0).norm();
  }
  EXPECT_NEAR(last, full, 0.02 * full);
  EXPECT_LE(jump, full / 50 * 1.1);
  EXPECT_EQ(haptic.flags(0) & silent_device, 0u);
}

}  // namespace
}  // namespace palpate
