#pragma once
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <thread>

#include "common/bus/dds_bus.hpp"
#include "common/realtime/clock.hpp"
#include "tests/bus/domain.hpp"
#include "tests/hostile/attacker.hpp"
#include "tests/loopback/loopback_scene.hpp"
#include "tools/shared/child_process.hpp"

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
  /// The haptic node gets a signal; false if it has not ended after five seconds.
  bool end(int signal) {
    kill(haptic_->pid(), signal);
    return haptic_->wait(std::chrono::seconds(5));
  }

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

/// One that says in the real haptic node's run, and in a run of its own, what no motor must be given.
class Forger {
 public:
  explicit Forger(const ForceState& real)
      : attacker_({.domain = own_domain()}), forces_(attacker_.writer(topics::force_state)), real_(real) {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the driver finds it
  }
  /// For half a second, two of each kind for each of the real ones.
  void forge() {
    for (int k = 0; k < 500; ++k) {
      say_absurd(real_.run);
      say_absurd(real_.run + 1);
      say(real_.run + 2, 5);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  /// In the run of a haptic node that has ended: only the driver itself is left to refuse it.
  void forge_of_the_dead() {
    std::this_thread::sleep_for(std::chrono::milliseconds(2700));  // the run is anybody's
    for (int k = 0; k < 100; ++k) {
      say_absurd(real_.run);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

 private:
  void say_absurd(std::uint64_t run) {
    for (const double newtons : {1e12, std::numeric_limits<double>::quiet_NaN()}) say(run, newtons);
  }
  void say(std::uint64_t run, double newtons) {
    ForceState force = real_;
    force.run = run;
    force.force = {newtons, newtons, -newtons};
    forces_.write(force);
  }
  Attacker attacker_;
  HostileWriter<ForceState> forces_;
  ForceState real_;
};

/// Presses, is killed, comes back, hears falsehoods, and outlives the haptic node, which is killed too.
inline void expect_a_whole_driver(DriverRig& rig, const std::vector<std::string>& command) {
  using namespace std::chrono_literals;
  const auto pressed = [](const ForceState& f) {
    return newtons(f) > 0.3 && newtons(f) < 10 && !(f.flags & silent_device) && now_ns() - f.sense_ns < 20'000'000;
  };
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
  ForceState real;
  ASSERT_TRUE(rig.hear(20s, [&](const ForceState& f) { return real = f, pressed(f); })) << "the next one takes it up";
  Forger forger(real);
  forger.forge();
  ASSERT_TRUE(rig.hear(20s, [&](const ForceState& f) { return f.run == real.run && pressed(f); }));
  ASSERT_TRUE(rig.end(SIGKILL));
  forger.forge_of_the_dead();
  driver.interrupt();
  ASSERT_TRUE(driver.wait(5s));
  EXPECT_EQ(driver.status(), 0);
  std::vector<std::string> said = driver.take_lines();
  ASSERT_GE(said.size(), 3u) << "it goes limp without forces, and says what it felt and what it refused";
  EXPECT_EQ(said[0], "limp: no force for 40 ms");
  said.erase(said.begin(), said.end() - 2);  // on a busy machine there are other silences
  fmt::print("{}\n", said[0]);
  double largest = 0, change = 0;
  ASSERT_EQ(
      std::sscanf(said[0].c_str(), "%*u samples, the largest force %lf N, the largest change %lf N", &largest, &change),
      2)
      << said[0];
  EXPECT_GE(largest, 0.3);
  EXPECT_LT(largest, 2) << "as the tissue gives it";
  EXPECT_LT(change, 0.15) << "[N] in a tick: no falsehood is felt, and a force that is lost fades";
  unsigned strange = 0, refused = 0;
  ASSERT_EQ(std::sscanf(said[1].c_str(), "not felt: %u forces of another run, %u out of range", &strange, &refused), 2)
      << said[1];
  EXPECT_GT(strange, 100u);
  EXPECT_GT(refused, 10u);
}

}  // namespace palpate::testing
