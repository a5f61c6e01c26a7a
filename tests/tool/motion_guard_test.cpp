#include "common/tool/motion_guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr double kStep = 1e-3;

bool same(const ToolDofs& a, const ToolDofs& b) {
  return a.yaw == b.yaw && a.pitch == b.pitch && a.depth == b.depth && a.roll == b.roll && a.grip == b.grip &&
         a.pedal == b.pedal;
}

TEST(MotionGuard, AMotionThatAHandMakesPassesInAllItsBits) {
  MotionGuard guard({}, kStep);
  for (int k = 0; k < 2000; ++k) {
    const double t = k * kStep;
    const ToolDofs sample{.yaw = 0.4 * std::sin(9 * t),
                          .pitch = 0.1 * std::cos(7 * t),
                          .depth = 0.15 + 0.04 * std::sin(20 * t),
                          .roll = 3 * std::sin(5 * t),
                          .grip = 0.4 + 0.4 * std::cos(15 * t),
                          .pedal = k % 2 ? 1.0 : 0.0};
    ASSERT_TRUE(same(guard.follow(sample, 0), sample)) << k;
  }
  EXPECT_EQ(guard.refused() + guard.followed(), 0u);
}

TEST(MotionGuard, ASampleThatCannotBeIsRefusedAndTheToolStandsStill) {
  MotionGuard guard({}, kStep);
  const ToolDofs place{.depth = 0.15};
  std::uint64_t seq = 0;
  guard.follow(place, ++seq);
  for (const double bad : {1e300, -1e300, 1e6, std::numeric_limits<double>::infinity(), std::nan("")})
    for (double ToolDofs::*dof :
         {&ToolDofs::yaw, &ToolDofs::pitch, &ToolDofs::depth, &ToolDofs::roll, &ToolDofs::grip}) {
      ToolDofs sample = place;
      sample.*dof = bad;
      EXPECT_TRUE(same(guard.follow(sample, ++seq), place));
      EXPECT_TRUE(same(guard.follow(sample, seq), place)) << "and while it is the newest";
      EXPECT_TRUE(same(guard.follow(place, ++seq), place));
    }
  EXPECT_EQ(guard.refused(), 25u);
}

TEST(MotionGuard, OutliersThatAlternateDoNotMoveTheTool) {
  MotionGuard guard({}, kStep);
  const ToolDofs place{.depth = 0.15};
  for (std::uint64_t seq = 1; seq < 1000; ++seq) {
    const ToolDofs sample{.depth = seq % 2 ? 0.15 : 0.5};
    ASSERT_TRUE(same(guard.follow(sample, seq), place)) << seq;
  }
  EXPECT_EQ(guard.refused(), 499u);
}

TEST(MotionGuard, AJumpThatIsRealIsFollowedAtABoundedSpeed) {
  MotionGuard guard({}, kStep);
  double depth = guard.follow({.depth = 0.1}, 1).depth;
  std::uint64_t seq = 1;
  int steps = 0;
  for (; depth != 0.5 && steps < 1000; ++steps) {
    const double next = guard.follow({.depth = 0.5}, ++seq).depth;
    ASSERT_LE(next - depth, MotionLimits{}.max_speed * kStep * (1 + 1e-12));
    depth = next;
  }
  EXPECT_NEAR(steps, 0.4 / (MotionLimits{}.max_speed * kStep), 3);
  EXPECT_EQ(guard.refused(), 1u);
}

TEST(MotionGuard, ASlowDevicesSamplesAreFollowed) {
  MotionGuard guard({}, kStep);
  double depth = 0.1;
  for (int k = 0; k < 200; ++k) {  // 100 Hz, a hand of 1 m/s
    const auto seq = static_cast<std::uint64_t>(k / 10 + 1);
    depth = guard.follow({.depth = 0.1 + 0.01 * static_cast<double>(seq)}, seq).depth;
  }
  EXPECT_NEAR(depth, 0.3, 1e-12);
  EXPECT_EQ(guard.refused(), 0u);
}

TEST(MotionGuard, AScenesOwnLimitsHold) {
  MotionGuard guard({.max_angle = 0.5, .min_depth = 0.05, .max_depth = 0.2, .max_speed = 0.1, .jump = 0.01}, kStep);
  const ToolDofs place{.depth = 0.15};
  std::uint64_t seq = 0;
  guard.follow(place, ++seq);
  for (const ToolDofs& beyond : {ToolDofs{.yaw = 0.6, .depth = 0.15}, ToolDofs{.pitch = -0.6, .depth = 0.15},
                                 ToolDofs{.depth = 0.21}, ToolDofs{.depth = 0.04}, ToolDofs{.depth = 0.165}})
    EXPECT_TRUE(same(guard.follow(beyond, ++seq), place));
  EXPECT_EQ(guard.refused(), 5u);
  EXPECT_NEAR(guard.follow({.depth = 0.16}, ++seq).depth, 0.15 + 0.1 * kStep, 1e-12);
  EXPECT_EQ(guard.followed(), 1u);
}

}  // namespace
}  // namespace palpate
