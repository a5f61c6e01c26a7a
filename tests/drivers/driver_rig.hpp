#pragma once
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <thread>

#include "common/bus/dds_bus.hpp"
#include "tests/bus/domain.hpp"
#include "tests/loopback/loopback_scene.hpp"
#include "tools/child_process.hpp"

namespace palpate::testing {

/// A haptic node whose tool waits for a driver elsewhere, above a block that it reaches at a depth of 0.192 m, and who
/// hears its forces.
class DriverRig {
 public:
  DriverRig() : block_("drivers", kLinear) {
    block_.replace("device = \"scripted\"\ntrajectory = \"motion.csv\"", "device = \"bus\"");
    std::string said;
    if (run_command(program("palpate") + " precompute " + scene(), &said) != 0) throw std::runtime_error(said);
    bus_ = make_dds_bus({.domain = own_domain()});
    forces_ = bus_->reader(topics::force_state, Keep::all);
    start();
  }

  std::string scene() const { return block_.scene(); }
  void start() {
    haptic_ = std::make_unique<ChildProcess>(
        "haptic_node",
        std::vector{program("haptic_node"), scene(), std::string("--domain"), std::to_string(own_domain())});
  }
  void stop() { haptic_.reset(); }

  /// Until a force is as asked; false if none is within the limit.
  template <class Until>
  bool hear(std::chrono::milliseconds limit, Until until) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (std::chrono::steady_clock::now() < end) {
      bus_->wait(std::chrono::milliseconds(10));
      while (const auto force = forces_->take())
        if (until(*force)) return true;
    }
    return false;
  }

 private:
  LoopbackScene block_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Reader<ForceState>> forces_;
  std::unique_ptr<ChildProcess> haptic_;
};

inline double newtons(const ForceState& f) {
  return std::hypot(f.force[0], f.force[1], f.force[2]);
}

/// Presses, is killed, comes back, and outlives the haptic node.
inline void expect_a_whole_driver(DriverRig& rig, const std::vector<std::string>& command) {
  using namespace std::chrono_literals;
  const auto pressed = [](const ForceState& f) { return newtons(f) > 0.3 && !(f.flags & silent_device); };
  {
    ChildProcess driver("driver", command);
    ASSERT_TRUE(rig.hear(20s, pressed)) << "it presses the block";
    kill(driver.pid(), SIGKILL);
    ASSERT_TRUE(rig.hear(1s, [](const ForceState& f) { return f.flags & silent_device; })) << "its silence is flagged";
    double last = 1e9;
    ASSERT_TRUE(rig.hear(1s, [&](const ForceState& f) {
      EXPECT_LE(newtons(f), last + 1e-9) << "the force only falls";
      last = newtons(f);
      return last == 0;
    }));
  }
  ChildProcess driver("driver", command);
  ASSERT_TRUE(rig.hear(20s, pressed)) << "the next one takes the tool up again";
  rig.stop();
  std::vector<std::string> said;
  const auto take = [&] {
    for (std::string& line : driver.take_lines()) said.push_back(std::move(line));
    return !said.empty();
  };
  for (int wait = 0; wait < 200 && !take(); ++wait) std::this_thread::sleep_for(10ms);
  ASSERT_FALSE(said.empty()) << "it goes limp without forces";
  EXPECT_EQ(said[0], "limp: no force for 100 ms");
  driver.interrupt();
  ASSERT_TRUE(driver.wait(5s));
  EXPECT_EQ(driver.status(), 0);
  take();
  ASSERT_EQ(said.size(), 2u);
  double largest = 0;
  ASSERT_EQ(std::sscanf(said[1].c_str(), "%*u samples, the largest force %lf N", &largest), 1) << said[1];
  EXPECT_GE(largest, 0.3);
}

}  // namespace palpate::testing
