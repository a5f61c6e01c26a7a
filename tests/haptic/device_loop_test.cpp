#include <gtest/gtest.h>

#include <array>

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

}  // namespace
}  // namespace palpate
