#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <thread>

#include "common/bus/memory_bus.hpp"
#include "haptic_node/haptic_loop.hpp"
#include "tests/haptic/block_scene.hpp"

namespace palpate {
namespace {

/// A hand that stands still until it is pushed: a mass whose tip starts pressed into the tissue, moved by nothing but
/// what the loop gives it in the same tick.
class MassOnATip : public Device {
 public:
  static constexpr double kMass = 0.5, kTick = 1e-3;  ///< [kg], [s]
  static constexpr std::size_t kMaxTicks = 300;

  struct Log {
    std::array<double, kMaxTicks> height{}, force{};  ///< [m] of the tip's centre above the tissue, [N] upwards
    std::size_t reads = 0, renders = 0;
  };
  explicit MassOnATip(Log& log) : log_(log) {}

  DeviceSample read(double) override {
    if (log_.reads < kMaxTicks) log_.height[log_.reads] = height_;
    ++log_.reads;
    return {{.depth = 0.2 - height_}, log_.reads};
  }
  void render(const Wrench& wrench, double) override {
    if (log_.renders < kMaxTicks) log_.force[log_.renders] = wrench.force.z();
    ++log_.renders;
    // It comes down by itself at first, then the force alone has it.
    speed_ = log_.renders < 40 ? -0.1 : speed_ + wrench.force.z() / kMass * kTick;
    height_ += speed_ * kTick;
  }
  bool finished(double) const override { return log_.reads >= kMaxTicks; }

 private:
  Log& log_;
  double height_ = 0.0085, speed_ = 0;
};

TEST(HapticLoop, ADeviceInTheProcessGetsItsForceInTheSameTickAndIsPushedOut) {
  testing::BlockScene block;
  HapticStep haptic(block.scene, block.archives);
  const std::unique_ptr<Bus> bus = make_memory_bus(make_memory_network());
  Presence presence(*bus, "haptic", 1, "scene", "archive");
  MassOnATip::Log log;
  std::vector<std::unique_ptr<Device>> devices;
  devices.push_back(std::make_unique<MassOnATip>(log));
  const std::array start{ToolDofs{.depth = 0.2 - 0.0085}};
  haptic.start(start);
  HapticLoop loop(haptic, devices, *bus, presence, 1, "a test");
  loop.run(0);
  ASSERT_GE(log.reads, MassOnATip::kMaxTicks);
  EXPECT_EQ(log.renders, log.reads);
  double deepest = 1, largest = 0;
  for (std::size_t i = 0; i < MassOnATip::kMaxTicks; ++i) {
    deepest = std::min(deepest, log.height[i]);
    largest = std::max(largest, log.force[i]);
    if (log.height[i] > 0.0081) {
      EXPECT_EQ(log.force[i], 0) << "in free air, tick " << i;
    }
  }
  EXPECT_LT(deepest, 0.006);
  EXPECT_GT(largest, 0.05);
  EXPECT_GT(log.height[MassOnATip::kMaxTicks - 1], 0.008) << "the tissue pushes the hand out";
}

/// Holds a tip pressed into the tissue, but for some samples.
class FaultyDevice : public Device {
 public:
  using Fault = std::function<double(std::size_t)>;  ///< depth [m] in place of the right one
  FaultyDevice(double depth, Fault fault, std::vector<double>& force)
      : depth_(depth), fault_(std::move(fault)), force_(force) {}

  DeviceSample read(double) override {
    ++reads_;
    const double down = std::min(1.0, static_cast<double>(reads_) / 100);
    const double fault = fault_(reads_);
    return {{.depth = fault != 0 ? fault : 0.19 + down * (depth_ - 0.19)}, reads_};
  }
  void render(const Wrench& wrench, double) override { force_.push_back(wrench.force.norm()); }
  bool finished(double) const override { return reads_ >= 400; }

 private:
  double depth_;
  Fault fault_;
  std::vector<double>& force_;
  std::size_t reads_ = 0;
};

LoopReport run_with(const FaultyDevice::Fault& fault, std::vector<double>& force) {
  testing::BlockScene block;
  HapticStep haptic(block.scene, block.archives);
  const std::unique_ptr<Bus> bus = make_memory_bus(make_memory_network());
  Presence presence(*bus, "haptic", 1, "scene", "archive");
  std::vector<std::unique_ptr<Device>> devices;
  force.reserve(1000);
  devices.push_back(std::make_unique<FaultyDevice>(0.197, fault, force));
  haptic.start(std::array{ToolDofs{.depth = 0.19}});
  HapticLoop loop(haptic, devices, *bus, presence, 1, "a test");
  return loop.run(0);
}

TEST(HapticLoop, ASampleThatCannotBeDoesNotTakeTheForceAwayForGood) {
  std::vector<double> force, undisturbed;
  run_with([](std::size_t) { return 0.0; }, undisturbed);
  for (const double bad : {1e300, std::nan(""), -3.0}) {
    force.clear();
    const LoopReport report = run_with([&](std::size_t k) { return k == 200 ? bad : 0.0; }, force);
    EXPECT_EQ(report.faults, 0u);
    EXPECT_EQ(report.refused_samples, 1u);
    ASSERT_GE(force.size(), 350u);
    EXPECT_GT(undisturbed[340], 0.05);
    EXPECT_NEAR(force[340], undisturbed[340], 0.01 * undisturbed[340]);
    for (std::size_t k = 1; k < 350; ++k) ASSERT_LT(std::abs(force[k] - undisturbed[k]), 1e-3) << k;
  }
}

TEST(HapticLoop, TakesTheForceAwayBeforeItLeavesAndDoesNotCallThatASilentDriver) {
  std::vector<double> force;
  const LoopReport report = run_with([](std::size_t) { return 0.0; }, force);
  ASSERT_GE(force.size(), 400u);
  EXPECT_GT(force[395], 0.05) << "pressed at the end";
  EXPECT_EQ(force.back(), 0);
  EXPECT_NEAR(static_cast<double>(force.size()), 420, 2) << "within 20 ms";
  for (std::size_t k = 400; k < force.size(); ++k) EXPECT_LT(force[k - 1] - force[k], force[395] / 15) << k;
  EXPECT_EQ(report.silent, 0u);
}

/// Takes longer than a tick, and tells of poses that cannot be.
class SlowDevice : public Device {
 public:
  DeviceSample read(double) override {
    std::this_thread::sleep_for(std::chrono::microseconds(1500));
    return {{.depth = ++reads_ % 8 == 0 ? std::nan("") : 0.15}, reads_};
  }
  void render(const Wrench&, double) override {}
  bool finished(double) const override { return false; }

 private:
  std::uint64_t reads_ = 0;
};

TEST(HapticLoop, TheStatusOfALoopThatFallsBehindNamesWhatStoodBeforeTheHandFirst) {
  testing::BlockScene block;
  HapticStep haptic(block.scene, block.archives);
  const auto network = make_memory_network();
  const std::unique_ptr<Bus> bus = make_memory_bus(network), observer = make_memory_bus(network);
  const auto statuses = observer->reader(topics::node_status);
  Presence presence(*bus, "haptic", 1, "scene", "archive");
  std::vector<std::unique_ptr<Device>> devices;
  devices.push_back(std::make_unique<SlowDevice>());
  haptic.start(std::array{ToolDofs{.depth = 0.15}});
  HapticLoop loop(haptic, devices, *bus, presence, 1, "a test");
  loop.run(3.3);
  std::string text;
  while (const auto status = statuses->take())
    if (status->text.find("falls behind") != std::string::npos) text = status->text;
  EXPECT_TRUE(text.starts_with("samples of a device are refused")) << text;
}

TEST(HapticLoop, ADeviceThatJumpsToAndFroIsNotFollowed) {
  std::vector<double> force, undisturbed;
  run_with([](std::size_t) { return 0.0; }, undisturbed);
  const LoopReport report = run_with([](std::size_t k) { return k > 200 && k % 2 == 0 ? 0.55 : 0.0; }, force);
  EXPECT_GT(report.refused_samples, 90u);
  EXPECT_EQ(report.followed_samples, 0u);
  for (std::size_t k = 1; k < 350; ++k) ASSERT_LT(std::abs(force[k] - undisturbed[k]), 1e-3) << k;
}

}  // namespace
}  // namespace palpate
