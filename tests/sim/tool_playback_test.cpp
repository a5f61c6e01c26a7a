#include "common/sim/tool_playback.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace palpate {
namespace {

constexpr double kPace = 5e-5;  // [m] of depth a step

ToolState at(std::uint64_t step, double depth) {
  return {.tool = 0, .run = 1, .step = step, .depth = depth};
}
ToolState on_the_way(std::uint64_t step) {
  return at(step, kPace * static_cast<double>(step));
}
ToolPlayback begun() {
  ToolPlayback playback;
  playback.begin(on_the_way(0));
  return playback;
}

TEST(ToolPlayback, WithAStateEachTickItIsWhereTheStateSays) {
  ToolPlayback playback;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  playback.begin(at(3, 0.1));
  for (std::uint64_t step = 4; step < 200; ++step) {
    const ToolState state = {.run = 1, .step = step, .yaw = any(random), .depth = any(random), .pedal = 1};
    playback.tick(&state);
    EXPECT_EQ(playback.dofs().yaw, state.yaw);
    EXPECT_EQ(playback.dofs().depth, state.depth);
    EXPECT_EQ(playback.dofs().pedal, 1);
  }
}

TEST(ToolPlayback, UnevenArrivalLeavesAnEvenMotion) {
  ToolPlayback playback = begun();
  std::mt19937 random(2);
  std::uint64_t newest = 0;
  double before = 0;
  for (std::uint64_t k = 1; k < 2000; ++k) {
    const std::uint64_t step = std::max<std::uint64_t>(newest, k - random() % std::min<std::uint64_t>(k, 3));
    const ToolState state = on_the_way(step);
    playback.tick(step > newest ? &state : nullptr);
    newest = step;
    const double moved = playback.dofs().depth - std::exchange(before, playback.dofs().depth);
    if (k > 3) {
      EXPECT_NEAR(moved, kPace, 0.07 * kPace) << k;
    }
    EXPECT_NEAR(playback.dofs().depth, kPace * static_cast<double>(k), 3 * kPace);
  }
}

TEST(ToolPlayback, ASilentToolGoesOnForAFewStepsAndComesToAStand) {
  ToolPlayback playback = begun();
  for (std::uint64_t k = 1; k <= 10; ++k) {
    const ToolState state = on_the_way(k);
    playback.tick(&state);
  }
  double before = 10 * kPace, moved = kPace;
  for (int k = 1; k <= 200; ++k) {
    playback.tick(nullptr);
    const double moves = playback.dofs().depth - std::exchange(before, playback.dofs().depth);
    EXPECT_NEAR(moves, k <= ToolPlayback::kAhead ? kPace : (1 - 1. / ToolPlayback::kFade) * moved, 1e-12) << k;
    moved = moves;
  }
  EXPECT_NEAR(before, kPace * (10 + ToolPlayback::kAhead + ToolPlayback::kFade - 1), 1e-3 * kPace);
}

TEST(ToolPlayback, WhatWasMissedIsMadeUpForGradually) {
  ToolPlayback playback = begun();
  double before = 0;
  for (std::uint64_t k = 1; k < 600; ++k) {
    const ToolState state = on_the_way(k <= 20 ? k : k + 40);  // 40 ticks are missed
    playback.tick(&state);
    const double moved = playback.dofs().depth - std::exchange(before, playback.dofs().depth);
    EXPECT_GE(moved, 0.999 * kPace);
    EXPECT_LE(moved, 1.001 * (1 + 40 / ToolPlayback::kMakeUpTicks) * kPace);
  }
  EXPECT_NEAR(before, kPace * 639, 0.01 * kPace);
}

TEST(ToolPlayback, ATissueTooSlowForItsTicksStillFollowsTheHand) {
  for (const double steps_per_tick : {1.3, 2.0, 3.6, 7.0}) {
    SCOPED_TRACE(steps_per_tick);
    ToolPlayback playback = begun();
    double before = 0;
    for (int k = 1; k < 1000; ++k) {
      const ToolState state = on_the_way(static_cast<std::uint64_t>(std::floor(k * steps_per_tick)));
      playback.tick(&state);
      const double moved = playback.dofs().depth - std::exchange(before, playback.dofs().depth);
      EXPECT_GE(moved, 0);
      if (k < 700) continue;
      EXPECT_NEAR(moved, steps_per_tick * kPace, 0.1 * steps_per_tick * kPace) << k;
      EXPECT_NEAR(playback.dofs().depth, kPace * k * steps_per_tick, 4 * kPace) << k;
      EXPECT_LT(playback.behind(), 0.02 * kPace) << k;
    }
  }
}

TEST(ToolPlayback, OfASlowTissueGoesOnFromASavedStateInAllBits) {
  ToolPlayback first = begun(), second;
  const auto tick = [](ToolPlayback& playback, std::uint64_t k) {
    const ToolState state = on_the_way(3 * k);
    playback.tick(&state);
  };
  for (std::uint64_t k = 1; k < 200; ++k) tick(first, k);
  std::vector<std::uint8_t> saved;
  State to = State::save(saved);
  first.state(to);
  State from = State::restore(saved);
  second.state(from);
  for (std::uint64_t k = 200; k < 400; ++k) {
    tick(first, k);
    tick(second, k);
    ASSERT_EQ(first.dofs().depth, second.dofs().depth) << k;
  }
}

TEST(ToolPlayback, BurstsAreNoSlowTissue) {
  ToolPlayback playback = begun();
  double before = 0;
  for (std::uint64_t k = 1; k < 2000; ++k) {
    const ToolState state = on_the_way(k);
    playback.tick(k % 4 == 0 ? &state : nullptr);  // four states every fourth tick
    const double moved = playback.dofs().depth - std::exchange(before, playback.dofs().depth);
    if (k < 100) continue;
    EXPECT_NEAR(moved, kPace, 0.07 * kPace) << k;
  }
}

TEST(ToolPlayback, HugeStatesStayNumbers) {
  ToolPlayback playback = begun();
  const double huge = std::numeric_limits<double>::max();
  for (std::uint64_t k = 1; k < 50; ++k) {
    const ToolState state = at(7 * k, k % 2 ? huge : -huge);
    playback.tick(k % 3 ? &state : nullptr);
    EXPECT_TRUE(std::isfinite(playback.dofs().depth));
  }
}

}  // namespace
}  // namespace palpate
