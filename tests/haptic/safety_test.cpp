#include "common/tool/safety.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "idl/messages.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

TEST(Safety, TheForceNeverExceedsItsLimitAndTorqueShrinksWithIt) {
  SafetyChain chain(5.0, 1e9, 1e-3);
  PortForce given{{30, 0, 40}, {1, 2, 3}};
  const auto flags = chain.apply(given, {});
  EXPECT_EQ(flags, force_limited);
  EXPECT_NEAR(given.force.norm(), 5.0, 1e-12);
  EXPECT_NEAR((given.torque - 0.1 * Vector3d(1, 2, 3)).norm(), 0, 1e-12);
}

TEST(Safety, ATorqueWithoutForceIsLimitedToo) {
  const double most = 5 * SafetyChain::kMaxLever;
  SafetyChain chain(5.0, 1000, 1e-3);
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i < 20; ++i) {
    PortForce given{{1e-3, 0, 0}, {0, 5e8, 0}};
    EXPECT_TRUE(chain.apply(given, {}) & force_limited);
    EXPECT_LE(given.torque.norm(), most + 1e-12);
    EXPECT_LE((given.torque - last).norm(), 1000 * 1e-3 * SafetyChain::kMaxLever + 1e-12);
    last = given.torque;
  }
  EXPECT_NEAR(last.norm(), most, 1e-9);
}

/// A chain of 10 N and 250 N/s at 1 kHz that gives 5 N upwards.
struct Pressed {
  Pressed() {
    for (int i = 0; i < 20; ++i) give({0, 0, 5});
  }
  /// [N] on the tool, which has moved by `shift` [m] in the tick, where the tissue asks for this.
  Vector3d give(const Vector3d& force, const Vector3d& shift = Vector3d::Zero()) {
    PortForce given{.force = force};
    flags = chain.apply(given, {.motion = {.shift = shift}});
    return given.force;
  }
  SafetyChain chain{10.0, 250, 1e-3};
  std::uint32_t flags = 0;
};

TEST(Safety, NoTickChangesTheForceByMoreThanTheSlewLimitInAnyDirection) {
  const std::array asked{Vector3d(0, 0, 8), Vector3d(0, 0, 0), Vector3d(0, 0, -8), Vector3d(8, 0, 5),
                         Vector3d(-3, 4, 0)};
  for (const Vector3d& wanted : asked)
    for (const Vector3d& shift : {Vector3d(0, 0, 0), Vector3d(0, 0, -1e-3), Vector3d(1e-4, 0, 0)}) {
      Pressed pressed;
      Vector3d last(0, 0, 5);
      int ticks = 0;
      for (; last != wanted && ticks < 100; ++ticks) {
        const Vector3d now = pressed.give(wanted, shift);
        ASSERT_LE((now - last).norm(), 0.25 + 1e-12) << "tick " << ticks;
        EXPECT_EQ(pressed.flags, now == wanted ? 0u : slew_limited);
        last = now;
      }
      EXPECT_EQ(ticks, std::ceil((wanted - Vector3d(0, 0, 5)).norm() / 0.25));
    }
}

TEST(Safety, WhatIsHeldOnToPutsNoMoreIntoAHandThatMovesAwayThanItMay) {
  for (const double speed : {0.005, 0.05, 0.2, 1.0, 2.0}) {
    Pressed pressed;
    double energy = 0, last = 5;
    for (int i = 0; i < 40; ++i) {
      const double now = pressed.give(Vector3d::Zero(), {0, 0, 1e-3 * speed}).z();
      EXPECT_GE(now, 0) << "none comes from the other side";
      EXPECT_GE(last - now, std::min(last, 0.25) - 1e-12) << "it goes as fast as it may";
      if (speed < 0.02) {
        EXPECT_LE(last - now, 0.25 + 1e-12) << "a hand that is slow does not gain much";
      }
      energy += now * 1e-3 * speed;
      last = now;
    }
    EXPECT_EQ(last, 0);
    EXPECT_LE(energy, SafetyChain::kMaxHeldOn * 1.5) << speed << " m/s";
  }
}

// Each tick lets so much go that a millijoule would be left if what is asked for stayed as it is. Where it goes on
// falling faster than the force may, what is held on to comes to rest at s [N] of which that is true, s^2 v / 2r, and
// pushes the hand over all the way F / k that the spring unloads.
TEST(Safety, AStiffContactThatAHandLeavesIsFollowed) {
  constexpr double force = 5, rate = 250, speed = 1, dt = 1e-3, way = speed * dt;
  for (const double stiffness : {250, 300, 500, 1000, 2000, 5000}) {
    Pressed pressed;
    double energy = 0, change = 0, last = force;
    for (int i = 1; i < 60; ++i) {
      const double asked = std::max(0.0, force - stiffness * way * i);
      const double now = pressed.give({0, 0, asked}, {0, 0, way}).z();
      energy += (now - asked) * way;
      change = std::max(change, last - now);
      last = now;
    }
    const double held_on = std::sqrt(2 * rate * SafetyChain::kMaxHeldOn / speed);
    const double most = stiffness * speed <= rate ? 0 : held_on * force / stiffness + 1.5 * SafetyChain::kMaxHeldOn;
    std::printf("%4.0f N/m left at 1 m/s: %.2f mJ more than it stored, %.2f mJ, at most %.2f mJ; %.2f N in a tick\n",
                stiffness, 1e3 * energy, 1e3 * force * force / stiffness / 2, 1e3 * most, change);
    EXPECT_LE(energy, most + 1e-12);
    EXPECT_GE(energy, 0.6 * (most - 1.5 * SafetyChain::kMaxHeldOn)) << "the bound is no idle one";
    EXPECT_LE(change, stiffness * way + 1e-9) << "no faster than the spring itself goes";
  }
}

TEST(Safety, AFaultRampsToZeroWithinFiveMillisecondsAndStays) {
  const double none = std::nan("");
  for (const PortForce& asked : {PortForce{{3, 0, 0}}, PortForce{{none, 0, 0}}, PortForce{{0, INFINITY, 0}},
                                 PortForce{.torque = {0, none, 0}}, PortForce{.grip = none}}) {
    SafetyChain chain(10, 1e6, 1e-3);
    PortForce given{{0, 4, 0}, {0.1, 0, 0}, 0.2};
    chain.apply(given, {});
    PortForce last = given;
    for (int i = 0; i < 5; ++i) {
      given = asked;
      EXPECT_TRUE(chain.apply(given, {.healthy = i > 0}) & fault);
      EXPECT_TRUE(given.force.allFinite() && given.torque.allFinite() && std::isfinite(given.grip));
      EXPECT_LT(given.force.norm(), last.force.norm());
      EXPECT_LT(given.torque.norm(), last.torque.norm());
      EXPECT_LT(given.grip, last.grip);
      last = given;
    }
    EXPECT_LT(last.force.norm() + last.torque.norm() + last.grip, 1e-12);
    given = {{1, 0, 0}, {}, 0.2};
    chain.apply(given, {});
    EXPECT_LT(given.force.norm() + given.grip, 1e-12);
  }
}

TEST(Safety, ATorqueOfTheHandleThatIsNoNumberIsAFault) {
  for (const double asked : {std::nan(""), double{INFINITY}}) {
    SafetyChain chain(10, 250, 1e-3);
    PortForce given{.grip = asked};
    EXPECT_EQ(chain.apply(given, {}), fault);
    EXPECT_EQ(given.grip, 0);
  }
}

TEST(Safety, TheTorqueOnTheHandleIsLimitedInSizeAndChangeAndLeavesTheForceAlone) {
  SafetyChain chain(10, 250, 1e-3);
  const double most = 10 * SafetyChain::kHandleLever, by = 0.25 * SafetyChain::kHandleLever;
  double last = 0, largest = 0;
  for (const double asked : {50.0, -50.0, 1e308, 0.3}) {
    for (int i = 0; i < 100; ++i) {
      PortForce given{.force = {0.1, 0, 0}, .grip = asked};
      const std::uint32_t flags = chain.apply(given, {});
      EXPECT_EQ((flags & force_limited) != 0, std::abs(asked) > most);
      EXPECT_EQ(given.force, Vector3d(0.1, 0, 0));
      ASSERT_LE(std::abs(given.grip - last), by + 1e-12);
      last = given.grip;
      largest = std::max(largest, std::abs(last));
    }
    EXPECT_DOUBLE_EQ(last, std::clamp(asked, -most, most));
  }
  EXPECT_DOUBLE_EQ(largest, most);
}

TEST(Safety, AHandleThatIsOpenedIsPushedNoMoreThanAHandThatLeaves) {
  for (const double speed : {0.1, 1.0, 10.0}) {  // rad/s
    SafetyChain chain(10, 250, 1e-3);
    PortForce given;
    for (int i = 0; i < 30; ++i) given = {.grip = 0.5}, chain.apply(given, {});
    double energy = 0, last = 0.5;
    for (int i = 0; i < 40; ++i) {
      given = {};
      chain.apply(given, {.motion = {.opening = 1e-3 * speed}});
      EXPECT_GE(given.grip, 0);
      EXPECT_GE(last - given.grip, std::min(last, 0.025) - 1e-12);
      energy += given.grip * 1e-3 * speed;
      last = given.grip;
    }
    EXPECT_EQ(last, 0);
    EXPECT_LE(energy, SafetyChain::kMaxHeldOn * 1.5) << speed << " rad/s";
  }
}

TEST(Safety, AKeptStateHoldsTheTorqueOnTheHandle) {
  SafetyChain chain(10, 250, 1e-3), other(10, 250, 1e-3);
  for (int i = 0; i < 5; ++i) {
    PortForce given{.grip = 0.5};
    chain.apply(given, {});
  }
  other.set_state(chain.state());
  PortForce given{.grip = 0.5}, again = given;
  chain.apply(given, {});
  other.apply(again, {});
  EXPECT_EQ(again.grip, given.grip);
  EXPECT_NEAR(given.grip, 0.15, 1e-12);
}

}  // namespace
}  // namespace palpate
