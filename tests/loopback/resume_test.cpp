#include <gtest/gtest.h>

#include <csignal>
#include <thread>

#include "common/bus/dds_bus.hpp"
#include "common/realtime/clock.hpp"
#include "tests/bus/domain.hpp"
#include "tests/loopback/loopback_scene.hpp"
#include "tools/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using testing::kLinear;
using testing::LoopbackScene;
using testing::own_domain;
using testing::program;
using testing::run_command;

/// A driver that holds the tool at a depth, as a device elsewhere would.
class Driver {
 public:
  Driver()
      : bus_(make_dds_bus({.domain = own_domain()})),
        writer_(bus_->writer(topics::device_state)),
        forces_(bus_->reader(topics::force_state)) {}

  /// Publishes for a while at about 500 Hz and returns the last force that came back.
  std::optional<ForceState> drive(double from, double to, std::chrono::milliseconds time) {
    std::optional<ForceState> last;
    const auto begin = std::chrono::steady_clock::now();
    for (auto now = begin; now < begin + time; now = std::chrono::steady_clock::now()) {
      const double share = std::chrono::duration<double>(now - begin) / std::chrono::duration<double>(time);
      if (const auto force = step(from + share * (to - from))) last = force;
    }
    return last;
  }
  /// Holds the tool there until `enough` says so; false if that is not within ten seconds.
  template <class Enough>
  bool hold(double depth, Enough&& enough) {
    const auto limit = std::chrono::steady_clock::now() + 10s;
    while (!enough(step(depth)))
      if (std::chrono::steady_clock::now() > limit) return false;
    return true;
  }

 private:
  std::optional<ForceState> step(double depth) {
    writer_->write({.tool = 0, .seq = ++seq_, .sense_ns = now_ns(), .depth = depth});
    std::this_thread::sleep_for(2ms);
    std::optional<ForceState> last;
    while (auto force = forces_->take()) last = *force;
    return last;
  }

  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Writer<DeviceState>> writer_;
  std::unique_ptr<Reader<ForceState>> forces_;
  std::uint64_t seq_ = 0;
};

TEST(Resume, AHapticNodeKilledInContactComesBackIntoItAndAFreshOneIsRefused) {
  LoopbackScene scene("resume", kLinear);
  scene.replace("device = \"scripted\"\ntrajectory = \"motion.csv\"", "device = \"bus\"");
  std::string said;
  ASSERT_EQ(run_command(program("palpate") + " precompute " + scene.scene(), &said), 0) << said;
  const std::vector<std::string> network{"--domain", std::to_string(own_domain())};
  const auto start = [&](const std::string& name) {
    return ChildProcess(name, {program(name), scene.scene(), network[0], network[1]});
  };

  Driver driver;
  ChildProcess deform = start("deform_node");
  double held = 0;
  std::uint64_t run = 0;
  {
    ChildProcess haptic = start("haptic_node");
    ASSERT_TRUE(driver.hold(0.18, [](const auto& force) { return force && force->step > 300; }));
    const auto pressed = driver.drive(0.18, 0.198, 1000ms);
    const auto rest = driver.drive(0.198, 0.198, 300ms);
    ASSERT_TRUE(pressed && rest);
    held = rest->force[2];
    ASSERT_GT(held, 0.1);
    run = rest->run;
    kill(haptic.pid(), SIGKILL);
    ASSERT_TRUE(haptic.wait(5s));
  }
  {
    ChildProcess again = start("haptic_node");
    EXPECT_TRUE(driver.hold(0.198, [&](const auto& force) {
      return !again.running() || (force && force->run != run && force->step > 300);
    }));
    const auto force = driver.drive(0.198, 0.198, 500ms);
    ASSERT_TRUE(again.running()) << "it takes up the contacts that the deformation node kept";
    ASSERT_TRUE(force);
    EXPECT_NEAR(force->force[2], held, 0.02 * held);
    kill(again.pid(), SIGKILL);
    ASSERT_TRUE(again.wait(5s));
  }
  kill(deform.pid(), SIGKILL);
  ASSERT_TRUE(deform.wait(5s));
  std::this_thread::sleep_for(500ms);
  ChildProcess fresh = start("haptic_node");
  EXPECT_TRUE(driver.hold(0.198, [&](const auto&) { return !fresh.running(); }))
      << "nobody keeps its contacts: it must not start inside the organ";
  EXPECT_EQ(fresh.status(), 1);
}

}  // namespace
}  // namespace palpate
