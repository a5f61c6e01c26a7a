#include "common/tool/passivity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "common/sim/haptic_step.hpp"
#include "common/tool/safety.hpp"
#include "tests/haptic/closed_loop.hpp"
#include "tests/haptic/local_models_for_tests.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::BlockScene;

constexpr double kTick = 1e-3;

/// One tool whose force a function of place and time gives, held from tick to tick and moved by hand.
struct OnePort {
  explicit OnePort(bool controller = true, double reserve = 0.01)
      : guard({.controller = controller, .reserve = reserve}, {&port}, 20, kTick) {}
  OnePort(const OnePort&) = delete;
  OnePort& operator=(const OnePort&) = delete;

  PortForce tick(const Vector3d& to, const PortForce& asked) {
    port.motion = {.shift = to - at};
    at = to;
    guard.observe();
    least = std::min(least, guard.energy());
    port.asked = asked;
    guard.control();
    port.held = port.asked;
    limited += port.limited;
    return port.held;
  }
  Vector3d tick(const Vector3d& to, const Vector3d& force) { return tick(to, PortForce{.force = force}).force; }
  const Vector3d& held() const { return port.held.force; }

  Port port;
  PassivityGuard guard;
  Vector3d at = Vector3d::Zero();
  double least = 0;
  int limited = 0;
};

TEST(Passivity, ASpringRoundAClosedPathGivesNoMoreThanItsSamplingDoes) {
  OnePort port(false);
  const Eigen::Matrix3d k = Vector3d(100, 250, 400).asDiagonal();
  double bound = 0;
  for (int i = 1; i <= 2000; ++i) {
    const double a = 2 * M_PI * i / 2000;
    const Vector3d x(0.01 * (std::cos(a) - 1), 0.005 * std::sin(2 * a), 0.008 * std::sin(3 * a));
    bound += 0.5 * (x - port.at).dot(k * (x - port.at));  // what a held spring force loses over a tick
    port.tick(x, Vector3d(-k * x));
  }
  EXPECT_GT(bound, 0);
  EXPECT_GE(port.guard.energy(), -bound - 1e-15);
  EXPECT_NEAR(port.guard.energy(), -bound, 1e-12) << "and exactly that";
}

TEST(Passivity, EnergyCountsTheForceThatWasHeldOverTheMotion) {
  OnePort port;
  port.tick({0, 0, 0}, Vector3d(0, 0, 2));
  port.tick({0, 0, -0.001}, Vector3d(0, 0, 50));
  EXPECT_NEAR(port.guard.energy(), 0.002, 1e-15) << "2 N over 1 mm against it, whatever comes next";
}

TEST(Passivity, TorqueAndGripCount) {
  Port port;
  PassivityGuard guard({}, {&port}, 10, kTick);
  port.held = {.torque = {0, 0.1, 0}, .grip = 0.2};
  const Eigen::Isometry3d before = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d now = before;
  now.rotate(Eigen::AngleAxisd(-0.01, Vector3d::UnitY()));
  port.motion = motion_between(before, now, 0.005);
  guard.observe();
  EXPECT_NEAR(guard.energy(), 0.1 * 0.01 - 0.2 * 0.005, 1e-7);
}

// A force that drives whatever moves, as a model gone wrong would: with the controller the hand gains the reserve at
// most.
TEST(Passivity, AnActiveSourceIsHeldToTheReserve) {
  for (const double reserve : {0.001, 0.01, 0.1}) {
    for (const double strength : {0.5, 5.0, 20.0}) {
      for (const bool controller : {true, false}) {
        OnePort port(controller, reserve);
        testing::Hand hand{.mass = 0.55, .damping = 6.5, .stiffness = 135};
        hand.at = {0.001, 0, 0};
        Vector3d force = Vector3d::Zero(), before = hand.at;
        port.at = hand.at;
        for (int i = 0; i < 4000; ++i) {
          hand.move(Vector3d::Zero(), force, kTick);
          const Vector3d motion = hand.at - before;
          before = hand.at;
          force = port.tick(hand.at, Vector3d(strength * motion.stableNormalized()));
          ASSERT_TRUE(force.allFinite());
          ASSERT_LE(force.norm(), strength + PassivityGuard::kMaxDamping / kTick * hand.speed.norm() * 1.1 + 1e-12);
        }
        if (controller) {
          EXPECT_GE(port.least, -reserve) << reserve << " J, " << strength << " N";
          EXPECT_GT(port.limited, 0);
        } else {
          EXPECT_LT(port.least, -1.1 * reserve) << "else the test shows nothing";
          EXPECT_EQ(port.limited, 0);
        }
      }
    }
  }
}

TEST(Passivity, WhereEnergyIsAmpleNothingIsTouched) {
  OnePort port(true, 1);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&] { return Vector3d(any(random), any(random), any(random)); };
  for (int i = 0; i < 2000; ++i) {
    const Vector3d asked = 3 * vector();
    ASSERT_EQ(port.tick(port.at + 1e-4 * vector(), asked), asked) << i;
  }
  EXPECT_EQ(port.limited, 0);
}

// The smallest case of a force that stood against the motion and pushes once it has turned round: a place that goes to
// and fro.
TEST(Passivity, AForceAgainstAMotionThatTurnsRoundTakesOutNoMoreThanTheReserve) {
  for (const bool controller : {true, false}) {
    OnePort port(controller);
    for (int i = 0; i < 1000; ++i) port.tick({i % 2 ? 2e-5 : 0, 0, 0}, Vector3d(i % 2 ? -10 : 10, 0, 0));
    if (controller)
      EXPECT_GE(port.least, -0.01);
    else
      EXPECT_LT(port.least, -0.19) << "else the test shows nothing";
  }
}

TEST(Passivity, AForceThatWasTakenAwayEarnsItsReturn) {
  for (const double speed : {0.002, 0.02, 0.2}) {
    OnePort port;
    for (int i = 0; i < 1000; ++i) port.tick({i % 2 ? 2e-5 : 0, 0, 0}, Vector3d(i % 2 ? -10 : 10, 0, 0));
    double travelled = 0;
    for (Vector3d given = Vector3d::Zero(); given.x() > -5 + 1e-12; travelled += speed * kTick) {
      given = port.tick({port.at.x() + speed * kTick, 0, 0}, Vector3d(-5, 0, 0));
      ASSERT_LE(given.x(), 0);
      ASSERT_LT(travelled, 0.01) << speed << " m/s: locked out at " << given.x() << " N";
    }
    std::printf("%.3f m/s: 5 N are back after %.2f mm\n", speed, 1e3 * travelled);
  }
}

// By tools that were thrown about three quarters of the reserve are gone, and the largest change of motion is far more
// than a hand makes.
TEST(Passivity, AHandThatRestsHasItsForceBackSoonAfterAThrow) {
  OnePort port;
  for (int i = 0; i < 1000 && port.guard.energy() > -0.006; ++i) port.tick({i % 2 ? 1e-3 : 0, 0, 0}, Vector3d(3, 0, 0));
  ASSERT_LT(port.guard.energy(), -0.006);
  ASSERT_LT(port.tick(port.at, Vector3d(0, 0, 2)).z(), 1.9) << "else the test shows nothing";
  for (int i = 0; i < 10'000; ++i) port.tick(port.at, Vector3d(0, 0, 2));
  EXPECT_EQ(port.held().z(), 2);
}

TEST(Passivity, OfTwoToolsTheOneThatRisksMoreIsTakenItsForceFirst) {
  Port thrown, resting;
  PassivityGuard guard({.controller = true, .reserve = 0.01}, {&thrown, &resting}, 20, kTick);
  int limited = 0;
  for (int i = 0; i < 200; ++i) {
    const double by = guard.energy() > -0.005 ? 2e-4 : 7e-4;  // half the reserve is spent, then the tool is thrown
    thrown.motion = {.shift = {i % 2 ? by : -by, 0, 0}};
    guard.observe();
    thrown.asked = {.force = {i % 2 ? -2.0 : 2.0, 0, 0}};
    resting.asked = {.force = {0, 0, 2}};
    guard.control();
    for (Port* port : {&thrown, &resting}) port->held = port->asked;
    if (guard.energy() < -0.009) continue;
    ASSERT_EQ(resting.held.force.z(), 2) << guard.energy() << " J";
    limited += thrown.held.force.norm() < 1.99;
  }
  EXPECT_GT(limited, 0) << "else the test shows nothing";
}

// Whatever the motion within the acceleration, and whatever is asked.
TEST(Passivity, NoMotionWithinTheAccelerationTakesOutMoreThanTheReserve) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&] { return Vector3d(any(random), any(random), any(random)); };
  constexpr double turn = PassivityGuard::kMaxAcceleration * kTick * kTick;
  for (const double slew : {1e5, 2e4, 250.0})
    for (int run = 0; run < 60; ++run) {
      Port port;
      PassivityGuard guard({.controller = true, .reserve = 0.01}, {&port}, 20, kTick);
      SafetyChain chain(20, slew, kTick);
      Vector3d motion = Vector3d::Zero(), given = Vector3d::Zero(), asked = Vector3d::Zero();
      double least = 0;
      const double malice = 0.25 * (run % 5);
      for (int i = 0; i < 3000; ++i) {
        const Vector3d drawn = vector();
        motion += 0.58 * turn * ((1 - malice) * drawn + malice * std::sqrt(3.0) * given.stableNormalized());
        if (motion.norm() > 5e-4) motion *= 5e-4 / motion.norm();
        port.motion = {.shift = motion};
        guard.observe();
        least = std::min(least, guard.energy());
        if (i % (1 + run % 7) == 0)
          asked = run % 2 ? Vector3d(12 * vector()) : Vector3d(-20 * motion.stableNormalized());
        port.asked = {.force = asked};
        guard.control();
        port.held = port.asked;
        chain.apply(port.held, {port.motion, port.spare});
        given = port.held.force;
      }
      EXPECT_GE(least, -0.01) << "slew " << slew << ", run " << run;
    }
}

TEST(Passivity, OneToolMayTakeOutWhatAnotherPutIn) {
  Port giving, taking;
  PassivityGuard guard({.controller = true, .reserve = 1e-3}, {&giving, &taking}, 20, kTick);
  for (int i = 0; i < 1000; ++i) {
    giving.motion = taking.motion = {.shift = {1e-4, 0, 0}};
    guard.observe();
    giving.asked = {.force = {-2, 0, 0}};
    taking.asked = {.force = {1.99, 0, 0}};
    guard.control();
    ASSERT_FALSE(taking.limited) << i;
    for (Port* port : {&giving, &taking}) port->held = port->asked;
  }
  EXPECT_NEAR(guard.energy(), 999 * 0.01 * 1e-4, 1e-12);
}

TEST(Passivity, StandingStillAndTinyMotionGiveNoNonsense) {
  for (const double step : {0.0, 1e-300, 1e-160, 1e-13, 1e-11}) {
    OnePort port(true, 1e-30);
    for (int i = 0; i < 100; ++i) {
      const Vector3d to(step * (i % 2), 0, 0);
      const Vector3d given = port.tick(to, Vector3d(10, -4, 3));
      ASSERT_TRUE(given.allFinite());
      ASSERT_LE(given.norm(), Vector3d(10, -4, 3).norm() + 1e-12);
    }
  }
  OnePort port;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  port.port.held = {.force = {5, 0, 0}};
  port.port.motion = {.shift = {0.01, 0, 0}};
  port.guard.observe();
  port.port.asked = {.force = {nan, 0, 0}};
  port.guard.control();
  EXPECT_FALSE(port.port.limited) << "what is not finite is the safety chain's";
  EXPECT_NEAR(port.guard.energy(), -0.05, 1e-15);
}

/// A wall whose force comes late, under the hand that pushes into it.
struct DelayedWall {
  double stiffness;
  int delay;  ///< [ticks]

  struct Result {
    double least, swing, largest;
    int limited;
  };
  Result run(bool controller) const {
    OnePort port(controller);
    testing::Hand hand{.mass = 0.55, .damping = 6.5, .stiffness = 135};
    hand.at = {0, 0, 0.01};
    port.at = hand.at;
    std::vector<double> late(static_cast<std::size_t>(delay) + 1, 0.0);
    Vector3d force = Vector3d::Zero();
    double low = 1, high = -1, largest = 0;
    for (int i = 0; i < 6000; ++i) {
      hand.move({0, 0, -0.01}, force, kTick);
      late[i % late.size()] = std::clamp(-stiffness * hand.at.z(), 0.0, 20.0);
      force = port.tick(hand.at, Vector3d(0, 0, late[(i + 1) % late.size()]));
      largest = std::max(largest, force.norm());
      if (i < 5000) continue;
      low = std::min(low, hand.at.z());
      high = std::max(high, hand.at.z());
    }
    return {port.least, high - low, largest, port.limited};
  }
};

TEST(Passivity, ADelayedWallGivesTheHandNoMoreThanTheReserve) {
  for (const int delay : {0, 5, 20, 50}) {
    const DelayedWall wall{1500, delay};
    const auto with = wall.run(true), without = wall.run(false);
    std::printf(
        "delay %2d ms: without swing %.2f mm, least energy %.2f mJ; with %.2f mm, %.2f mJ, %d of 6000 steps damped\n",
        delay, 1e3 * without.swing, 1e3 * without.least, 1e3 * with.swing, 1e3 * with.least, with.limited);
    EXPECT_GE(with.least, -0.01) << delay;
    EXPECT_LE(with.largest, 20 + 1e-9) << delay;
    if (delay >= 20) {
      EXPECT_LT(without.least, -0.05) << "else the test shows nothing";
      EXPECT_LT(with.swing, 0.7 * without.swing) << delay;
      EXPECT_GT(with.limited, 0);
    }
    if (delay == 0) {
      EXPECT_EQ(with.limited, 0) << "a wall within Colgate's bound is left alone";
    }
  }
}

/// A block under a tool that is pressed in and out: the real step.
class PassivityInTheStep : public ::testing::Test {
 protected:
  static Vector3d tip(int i) { return {0.002 * std::sin(0.011 * i), 0, 0.008 - 0.006 * std::sin(0.03 * i)}; }
};

TEST_F(PassivityInTheStep, PressesOnTissueAreNotLimitedAndTheEnergyIsTheWorkOfTheForces) {
  const BlockScene block;
  HapticStep haptic(block.scene, block.archives);
  const Tool& tool = block.scene.tools[0];
  haptic.start(std::array{tip_at(tool, tip(0))});
  double work = 0;
  Eigen::Isometry3d before = haptic.pose(0);
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
  for (int i = 0; i < 3000; ++i) {
    haptic.step(std::array{tip_at(tool, tip(i))});
    const Eigen::AngleAxisd turn(haptic.pose(0).linear() * before.linear().transpose());
    work -= force.dot(haptic.pose(0).translation() - before.translation()) + torque.dot(turn.angle() * turn.axis());
    ASSERT_NEAR(haptic.energy(), work, 1e-9) << i;
    ASSERT_EQ(haptic.flags(0) & passivity_limited, 0u) << i;
    before = haptic.pose(0);
    force = haptic.force(0);
    torque = haptic.torque(0);
  }
  EXPECT_GT(std::abs(work), 1e-6);
}

TEST_F(PassivityInTheStep, ASavedStateGoesOnBitForBitWhileDamped) {
  Scene scene = testing::moving_block_scene(0.008);
  scene.passivity.reserve = 1e-4;
  const std::vector<Archive> none(1);
  HapticStep a(scene, none), b(scene, none);
  const Tool& tool = scene.tools[0];
  a.start(std::array{tip_at(tool, {0, 0, 0})});
  std::vector<std::uint8_t> state(a.state_size());
  int limited = 0;
  for (int i = 0; i < 2000; ++i) {
    // A model that pushes the tool whichever way it goes, for its force is that of a place it has left.
    LocalContactModel m = testing::empty_model(tool, {0, 0, 0}, i, i + 1);
    testing::add_contact(m, {0, 0, -0.008}, {0, 0, i % 40 < 20 ? -0.2 : -3.0}, 0);
    ASSERT_TRUE(a.consume(m));
    if (i == 1000) {
      a.save(state);
      b.restore(state);
    }
    const std::array dofs{tip_at(tool, {0, 0, (i % 40 < 20 ? -1 : 1) * 1e-3 * std::abs(std::sin(M_PI * i / 20))})};
    a.step(dofs);
    limited += (a.flags(0) & passivity_limited) != 0;
    ASSERT_GE(a.energy(), -1e-3) << i;
    if (i < 1000) continue;
    ASSERT_TRUE(b.consume(m));
    b.step(dofs);
    ASSERT_EQ(a.force(0), b.force(0)) << i;
    ASSERT_EQ(a.energy(), b.energy()) << i;
    ASSERT_EQ(a.flags(0), b.flags(0)) << i;
  }
  EXPECT_GT(limited, 20);
}

TEST(Passivity, NothingIsAllocated) {
  OnePort port(true, 1e-9);
  const long before = allocations();
  for (int i = 0; i < 1000; ++i) port.tick({1e-4 * i, 0, 0}, Vector3d(3, 1, 0));
  EXPECT_EQ(allocations() - before, 0);
  EXPECT_GT(port.limited, 900);
}

}  // namespace
}  // namespace palpate
