#include "common/sim/tissue_tool.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

namespace palpate {
namespace {

constexpr double kTick = 1e-3;          // [s]
constexpr double kLengthOfStep = 5e-5;  // [m] of depth a step

/// Of a loop that began at time 0, has left out some steps since and began this one late [periods]; its hand has not.
ToolState told_at(std::uint64_t step, std::uint64_t left_out, double late = 0) {
  const double time = static_cast<double>(step + left_out) + late;
  return {.tool = 0,
          .run = 1,
          .step = step,
          .sense_ns = static_cast<std::int64_t>(1e6 * time),
          .depth = kLengthOfStep * time};
}

struct Moved {
  double least = std::numeric_limits<double>::max(), most = 0;  // [m] a tick
  double jump = 0;                                              // [m] a tick, from one tick to the next
  double last = 0;                                              // [m] depth in the end
};

// A loop that stands is not heard, and says afterwards where its hand has come to meanwhile.
Moved after_a_stand_of(std::uint64_t ticks) {
  constexpr std::uint64_t stands = 50, end = 600;
  TissueTool tool(Tool{}, kTick);
  Moved moved;
  double before = 0, moves = kLengthOfStep;
  for (std::uint64_t k = 0; k < end; ++k) {
    if (k <= stands) tool.take(told_at(k, 0));
    if (k > stands + ticks) tool.take(told_at(k - ticks, ticks));
    tool.tick(k);
    moved.last = tool.in_tick().dofs.depth;
    const double by = moved.last - std::exchange(before, moved.last);
    if (k > stands) moved.least = std::min(moved.least, by), moved.most = std::max(moved.most, by);
    if (k > stands) moved.jump = std::max(moved.jump, std::abs(by - std::exchange(moves, by)));
  }
  EXPECT_NEAR(moved.last, kLengthOfStep * (end - 1), kLengthOfStep);
  return moved;
}

TEST(TissueTool, GoesOnEvenlyWhereTheHapticLoopLeftOutAStepOrTwo) {
  for (const int ticks : {1, 2, 3}) {
    SCOPED_TRACE(ticks);
    const Moved moved = after_a_stand_of(ticks);
    EXPECT_GT(moved.least, 0.9 * kLengthOfStep);
    EXPECT_LT(moved.most, 1.1 * kLengthOfStep);
  }
}

// The first step after the stand begins late by as much of a period, the next one in time; both come in one tick.
TEST(TissueTool, GoesOnEvenlyWhereStepsAfterAStandBeganLate) {
  for (const double late : {0.05, 0.3, 0.7}) {
    SCOPED_TRACE(late);
    TissueTool tool(Tool{}, kTick);
    double before = 0;
    for (std::uint64_t k = 0; k < 200; ++k) {
      if (k <= 50) tool.take(told_at(k, 0));
      if (k == 53) tool.take(told_at(51, 1, late)), tool.take(told_at(52, 1));
      if (k > 53) tool.take(told_at(k - 1, 1));
      tool.tick(k);
      const double now = tool.in_tick().dofs.depth, by = now - std::exchange(before, now);
      if (k > 1) {
        EXPECT_NEAR(by, kLengthOfStep, 0.1 * kLengthOfStep) << k;
      }
    }
  }
}

// The step that a loop stood through begins late, and the next one in time, in whatever ticks they come.
TEST(TissueTool, GoesOnEvenlyWhereAStepBeganLateOrWasLeftOut) {
  for (const double late : {0.05, 0.3, 0.7, 0.95})
    for (const std::uint64_t left_out : {0, 1, 2})
      for (const std::uint64_t apart : {0, 1}) {
        SCOPED_TRACE(::testing::Message() << late << " late, " << left_out << " left out, ticks apart: " << apart);
        TissueTool tool(Tool{}, kTick);
        double before = 0;
        const std::uint64_t comes = 51 + left_out + 1;
        for (std::uint64_t k = 0; k < 200; ++k) {
          if (k <= 50) tool.take(told_at(k, 0));
          if (k == comes) tool.take(told_at(51, left_out, late));
          if (k == comes + apart) tool.take(told_at(52, left_out));
          if (k > comes + apart) tool.take(told_at(52 + k - comes - apart, left_out));
          tool.tick(k);
          const double now = tool.in_tick().dofs.depth, by = now - std::exchange(before, now);
          if (k > 1) {
            EXPECT_NEAR(by, kLengthOfStep, 0.2 * kLengthOfStep) << k;
          }
        }
      }
}

TEST(TissueTool, MakesUpGraduallyForWhatAHapticLoopThatStoodLeftOut) {
  for (const int ticks : {5, 20, 100}) {
    SCOPED_TRACE(ticks);
    const Moved moved = after_a_stand_of(ticks);
    EXPECT_GT(moved.least, -1e-3 * kLengthOfStep) << "it turns back";
    EXPECT_LT(moved.most, (1.1 + ticks / ToolPlayback::kMakeUpTicks) * kLengthOfStep);
    EXPECT_LT(moved.jump, (0.12 + 0.002 * ticks) * kLengthOfStep) << "it stops or goes on at once";
  }
}

TEST(TissueTool, TimesThatCannotBeMoveNothingBeyondWhereItsStatesSay) {
  TissueTool tool(Tool{}, kTick);
  for (std::uint64_t k = 0; k < 100; ++k) {
    ToolState state = told_at(k, 0);
    state.sense_ns = k % 2 ? std::numeric_limits<std::int64_t>::max() : std::numeric_limits<std::int64_t>::min();
    ASSERT_TRUE(tool.take(state));
    tool.tick(k);
    EXPECT_GE(tool.in_tick().dofs.depth, 0);
    EXPECT_LE(tool.in_tick().dofs.depth,
              kLengthOfStep * (static_cast<double>(k) + ToolPlayback::kAhead + ToolPlayback::kFade));
  }
}

}  // namespace
}  // namespace palpate
