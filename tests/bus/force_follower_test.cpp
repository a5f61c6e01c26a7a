#include "common/bus/force_follower.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace palpate {
namespace {

constexpr std::int64_t kTick = 1'000'000;       // [ns]
constexpr double kMaxForce = 5, kChange = 0.5;  // [N], [N] a tick

/// A driver's loop at 1 kHz.
class ForceFollowerTest : public ::testing::Test {
 protected:
  static ForceState told(double newtons, std::uint64_t run = 1) {
    return {.tool = 2, .run = run, .force = {0, 0, newtons}, .depth_force = -newtons};
  }
  double force() const { return given_.force[2]; }
  void tick() {
    now_ += kTick;
    const double before = force();
    given_ = follower_.give(now_);
    EXPECT_NEAR(given_.along[2], -force(), 1e-12) << "all that motors may use goes together";
    EXPECT_LE(std::abs(force()), kMaxForce * (1 + 1e-9));
    EXPECT_LE(std::abs(force()) - std::abs(before), kChange + 1e-9);
    largest_change_ = std::max(largest_change_, std::abs(force() - before));
  }
  void press(double newtons, int ticks, std::uint64_t run = 1) {
    for (int k = 0; k < ticks; ++k) follower_.hear(told(newtons, run), now_), tick();
  }

  ForceFollower follower_{2, {.max_force = kMaxForce, .max_torque = 1, .max_force_rate = 500}};
  std::int64_t now_ = 10'000 * kTick;
  MotorForce given_;
  double largest_change_ = 0;
};

TEST(ForceFollowerLimits, AreFiniteNumbersAboveZero) {
  for (double MotorLimits::*limit :
       {&MotorLimits::max_force, &MotorLimits::max_torque, &MotorLimits::max_grip, &MotorLimits::max_force_rate})
    for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(), 0.0, -1.0}) {
      MotorLimits limits;
      limits.*limit = value;
      EXPECT_THROW(ForceFollower(0, limits), std::runtime_error) << value;
    }
}

TEST_F(ForceFollowerTest, BringsAForceInGentlyAndThenGivesWhatIsTold) {
  press(2, 1);
  EXPECT_LT(force(), 0.25);
  press(2, 60);
  EXPECT_EQ(force(), 2);
  press(2.3, 1);
  EXPECT_EQ(force(), 2.3);
  press(0, 1);
  EXPECT_EQ(force(), 0) << "it falls as the haptic node tells it";
}

TEST_F(ForceFollowerTest, FadesWithoutAWordAndComesBackFromNothing) {
  press(4, 100);
  largest_change_ = 0;
  int ticks = 0;
  for (; !follower_.limp() && ticks < 100; ++ticks) tick();
  EXPECT_NEAR(ticks, 40, 1) << "[ms] of silence and fading";
  EXPECT_EQ(force(), 0);
  EXPECT_NEAR(largest_change_, 0.2, 1e-9) << "4 N within 20 ms";
  press(4, 1, 7);
  EXPECT_NEAR(force(), 0.08, 1e-9);
}

TEST_F(ForceFollowerTest, OfTwoLoopsFollowsTheFirstUntilThatIsSilent) {
  press(1, 100);
  for (int k = 0; k < 100; ++k) {
    EXPECT_FALSE(follower_.hear(told(-4, 9), now_));
    press(1, 1);
    EXPECT_EQ(force(), 1);
  }
  EXPECT_EQ(follower_.strange(), 100u);
  press(-4, 15, 9);
  EXPECT_EQ(force(), 1);
  for (double before = 1; force() > 0; before = force()) {
    press(-4, 1, 9);
    EXPECT_LE(force(), before);
  }
  press(-4, 60, 9);
  EXPECT_EQ(force(), -4);
}

TEST_F(ForceFollowerTest, NothingThatCannotBeIsFeltOrCountsAsAWord) {
  press(1, 100);
  const double none = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {none, infinite, -infinite, 1e12, -1e300}) {
    ForceState torque = told(1), grip = told(1), along = told(1);
    torque.torque[1] = grip.grip = along.roll_torque = bad;
    for (const ForceState& f : {told(bad), torque, grip, along}) EXPECT_FALSE(follower_.hear(f, now_));
    press(1, 1);
    EXPECT_EQ(force(), 1);
  }
  EXPECT_EQ(follower_.refused(), 20u);
  for (int k = 0; k < 60; ++k) follower_.hear(told(none), now_), tick();
  EXPECT_EQ(force(), 0);
}

TEST_F(ForceFollowerTest, MoreThanTheDeviceGivesIsShrunkToIt) {
  press(20, 200);
  EXPECT_NEAR(force(), kMaxForce, 1e-12);
  ForceState twisted = told(1);
  twisted.torque = {0, 4, 0};
  follower_.hear(twisted, now_);
  for (int k = 0; k < 15; ++k) tick();
  EXPECT_NEAR(given_.torque[1], 1, 1e-12);
  EXPECT_NEAR(force(), 0.25, 1e-12) << "with its torque";
}

TEST_F(ForceFollowerTest, AForceTurnsRoundAtItsRateAndALateDriverCatchesUpByLittle) {
  press(2, 100);
  largest_change_ = 0;
  press(-2, 1);
  EXPECT_EQ(force(), 1.5);
  press(-2, 20);
  EXPECT_EQ(force(), -2);
  now_ += 1000 * kTick;
  follower_.hear(told(4), now_);
  given_ = follower_.give(now_);
  EXPECT_EQ(force(), -1) << "1 N is 500 N/s times 2 ms";
}

TEST_F(ForceFollowerTest, AForceOfWhichStepsAreMissingFallsNoFasterThanItRises) {
  press(3, 100);
  ForceState later = told(0.25);
  later.step = 15;
  double before = force();
  for (int k = 0; k < 5; ++k, ++later.step, before = force()) {
    follower_.hear(later, now_);
    tick();
    EXPECT_NEAR(before - force(), kChange, 1e-9);
  }
  follower_.hear(later, now_);
  tick();
  EXPECT_EQ(force(), 0.25);
  later.force = {}, later.depth_force = 0;
  follower_.hear(later, now_);
  tick();
  EXPECT_EQ(force(), 0) << "it has caught up";
}

TEST_F(ForceFollowerTest, AnotherToolsForceIsNone) {
  ForceState other = told(3);
  other.tool = 1;
  EXPECT_FALSE(follower_.hear(other, now_));
  tick();
  EXPECT_EQ(force(), 0);
  EXPECT_EQ(follower_.strange() + follower_.refused(), 0u);
}

}  // namespace
}  // namespace palpate
