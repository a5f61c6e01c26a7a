#include "common/tool/hand_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

constexpr double kTick = 1e-3;

/// What a motion did, tick by tick [m].
struct Seen {
  double max_speed = 0;  ///< [m/s] of the depth
  double max_jerk = 0;   ///< [m/s] largest change of that speed between two ticks
  double last = 0, last_speed = 0;
  void look(double depth) {
    const double speed = (depth - last) / kTick;
    max_speed = std::max(max_speed, std::abs(speed));
    max_jerk = std::max(max_jerk, std::abs(speed - last_speed));
    last = depth;
    last_speed = speed;
  }
};

TEST(HandMotion, GoesWhereItIsLedWithinTheSpeedAndWithoutAJump) {
  HandMotion motion({}, kTick);
  motion.stand({.depth = 0.1});
  Seen seen{.last = 0.1};
  motion.aim({.depth = 0.2});
  for (int i = 0; i < 600; ++i) seen.look(motion.step().depth);
  EXPECT_NEAR(seen.last, 0.2, 1e-9);
  EXPECT_LE(seen.max_speed, 0.25 + 1e-9);
  EXPECT_LT(seen.max_jerk, 0.03) << "the speed has no steps";
}

TEST(HandMotion, SixtySamplesASecondMakeAnEvenMotion) {
  HandMotion motion({}, kTick);
  motion.stand({.depth = 0.1});
  Seen seen{.last = 0.1};
  double slowest = 1;
  for (int i = 0; i < 1000; ++i) {
    if (i % 17 == 0) motion.aim({.depth = 0.1 + 0.05 * i * kTick});  // 50 mm/s
    const double before = seen.last;
    seen.look(motion.step().depth);
    if (i > 200) slowest = std::min(slowest, (seen.last - before) / kTick);
  }
  EXPECT_GT(slowest, 0.03);
  EXPECT_LT(seen.max_speed, 0.07);
  EXPECT_NEAR(seen.last, 0.1 + 0.05, 0.05 * 0.04) << "behind by the delay, the filter and a sample at most";
}

TEST(HandMotion, LateAndMissingSamplesMakeNoJump) {
  HandMotion motion({}, kTick);
  motion.stand({.depth = 0.1});
  Seen seen{.last = 0.1};
  for (int i = 0; i < 1000; ++i) {
    if (i % 17 == 0 && i % 5 != 0 && (i < 400 || i > 460)) motion.aim({.depth = 0.1 + 0.1 * i * kTick});
    seen.look(motion.step().depth);
  }
  EXPECT_LE(seen.max_speed, 0.25 + 1e-9);
  EXPECT_LT(seen.max_jerk, 0.06);
}

TEST(HandMotion, TurnsAndSwingsAreBoundedToo) {
  HandMotion motion({}, kTick);
  motion.stand({.depth = 0.2});
  motion.aim({.yaw = 0.5, .depth = 0.2, .roll = 3, .grip = -1});
  ToolDofs last{.depth = 0.2};
  for (int i = 0; i < 800; ++i) {
    const ToolDofs now = motion.step();
    EXPECT_LE(0.2 * std::abs(now.yaw - last.yaw), 0.25 * kTick + 1e-12);
    EXPECT_LE(std::abs(now.roll - last.roll), 6 * kTick + 1e-12);
    last = now;
  }
  EXPECT_NEAR(last.yaw, 0.5, 1e-6);
  EXPECT_NEAR(last.roll, 3, 1e-6);
}

// A scripted tool that is taken while it moves, by one who says where it was a moment ago.
TEST(HandMotion, WhatIsTakenWhileItMovesComesToRestByAndBy) {
  HandMotion motion({}, kTick);
  motion.stand({.depth = 0.1});
  Seen seen{.last = 0.1};
  const auto script = [&](int i) { return 0.1 + 0.05 * i * kTick; };  // 50 mm/s
  for (int i = 1; i <= 100; ++i) motion.follow({.depth = script(i)});
  seen.last = script(100), seen.last_speed = 0.05;
  const double taken_at = script(70);
  double farthest = 0;
  for (int i = 0; i < 400; ++i) {
    if (i % 16 == 0) motion.aim({.depth = taken_at});
    seen.look(motion.step().depth);
    farthest = std::max(farthest, seen.last);
  }
  EXPECT_LT(seen.max_jerk, 0.003) << "3 m/s^2";
  EXPECT_LT(farthest - script(100), 0.003);
  EXPECT_NEAR(seen.last, taken_at, 1e-5);
}

TEST(HandMotion, WhatIsTakenAtRestIsLedAtOnce) {
  HandMotion motion({}, kTick);
  motion.stand({.depth = 0.1});
  for (int i = 0; i < 100; ++i) motion.follow({.depth = 0.1});
  motion.aim({.depth = 0.101});
  double depth = 0;
  for (int i = 0; i < 60; ++i) depth = motion.step().depth;
  EXPECT_NEAR(depth, 0.101, 1e-5);
}

// What led it may jump: that is not gone on with.
TEST(HandMotion, OfAJumpOfWhatLedItNoMoreIsLeftThanTheBounds) {
  HandMotion motion({}, kTick);
  motion.stand({.depth = 0.1});
  motion.follow({.depth = 0.15});
  Seen seen{.last = 0.15};
  for (int i = 0; i < 300; ++i) seen.look(motion.step().depth);
  EXPECT_LE(seen.max_speed, 0.25 + 1e-9);
  EXPECT_LT(seen.last, 0.163);
}

TEST(HandMotion, HoldsWhereItIsLedTo) {
  HandMotion motion({}, kTick);
  motion.stand({.depth = 0.1});
  motion.aim({.depth = 0.2});
  for (int i = 0; i < 100; ++i) motion.step();
  motion.hold();
  const double at = motion.step().depth;
  for (int i = 0; i < 300; ++i) motion.step();
  EXPECT_NEAR(motion.step().depth, at, 0.25 * 0.012) << "within what the filter still had to go";
}

}  // namespace
}  // namespace palpate
