#include "common/tool/safety.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "idl/messages.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

TEST(Safety, TheForceNeverExceedsItsLimitAndTorqueShrinksWithIt) {
  SafetyChain chain(5.0, 1e9, 1e-3);
  Vector3d force(30, 0, 40), torque(1, 2, 3);
  const auto flags = chain.apply(force, torque, {});
  EXPECT_EQ(flags, force_limited);
  EXPECT_NEAR(force.norm(), 5.0, 1e-12);
  EXPECT_NEAR((torque - 0.1 * Vector3d(1, 2, 3)).norm(), 0, 1e-12);
}

TEST(Safety, ATorqueWithoutForceIsLimitedToo) {
  const double most = 5 * SafetyChain::kMaxLever;
  SafetyChain chain(5.0, 1000, 1e-3);
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i < 20; ++i) {
    Vector3d force(1e-3, 0, 0), torque(0, 5e8, 0);
    EXPECT_TRUE(chain.apply(force, torque, {}) & force_limited);
    EXPECT_LE(torque.norm(), most + 1e-12);
    EXPECT_LE((torque - last).norm(), 1000 * 1e-3 * SafetyChain::kMaxLever + 1e-12);
    last = torque;
  }
  EXPECT_NEAR(last.norm(), most, 1e-9);
}

/// A chain of 10 N and 250 N/s at 1 kHz that gives 5 N upwards.
struct Pressed {
  Pressed() {
    for (int i = 0; i < 20; ++i) give({0, 0, 5});
  }
  /// [N] on the tool, which has moved by `shift` [m] in the tick, where the tissue asks for this.
  Vector3d give(Vector3d force, const Vector3d& shift = Vector3d::Zero()) {
    Vector3d torque = Vector3d::Zero();
    flags = chain.apply(force, torque, {.motion = {.shift = shift}});
    return force;
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
      if (speed < 0.02) EXPECT_LE(last - now, 0.25 + 1e-12) << "a hand that is slow does not gain much";
      energy += now * 1e-3 * speed;
      last = now;
    }
    EXPECT_EQ(last, 0);
    EXPECT_LE(energy, SafetyChain::kMaxHeldOn * 1.5) << speed << " m/s";
  }
}

TEST(Safety, AStiffContactThatAHandLeavesIsFollowed) {
  for (const double stiffness : {250, 1000, 5000}) {
    Pressed pressed;
    double energy = 0;
    for (int i = 1; i < 60; ++i) {
      const double asked = std::max(0.0, 5 - stiffness * 1e-3 * i);
      energy += (pressed.give({0, 0, asked}, {0, 0, 1e-3}).z() - asked) * 1e-3;
    }
    std::printf("%4.0f N/m left at 1 m/s: %.2f mJ more than it stored\n", stiffness, 1e3 * energy);
    EXPECT_LE(energy, 5 * SafetyChain::kMaxHeldOn);
  }
}

TEST(Safety, AFaultRampsToZeroWithinFiveMillisecondsAndStays) {
  for (const Vector3d& asked : {Vector3d(3, 0, 0), Vector3d(std::nan(""), 0, 0), Vector3d(0, INFINITY, 0)}) {
    SafetyChain chain(10, 1e6, 1e-3);
    Vector3d force(0, 4, 0), torque(0.1, 0, 0);
    chain.apply(force, torque, {});
    double last = force.norm();
    for (int i = 0; i < 5; ++i) {
      force = asked;
      torque = Vector3d::Zero();
      EXPECT_TRUE(chain.apply(force, torque, {.healthy = i > 0}) & fault);
      EXPECT_TRUE(force.allFinite());
      EXPECT_LT(force.norm(), last);
      last = force.norm();
    }
    EXPECT_LT(last, 1e-12);
    force = Vector3d(1, 0, 0);
    chain.apply(force, torque, {});
    EXPECT_LT(force.norm(), 1e-12);
  }
}

}  // namespace
}  // namespace palpate
