#include <fmt/format.h>
#include <gtest/gtest.h>

#include <span>

#include "tests/haptic/closed_loop.hpp"
#include "tests/sanitized.hpp"

/// The force of the local contact model beside that of the full model, with a hand and a device in the loop.
namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::Hand;
using testing::kSanitized;
using testing::LoopTrace;
using testing::TouchedBlock;

constexpr double kPeriod = 1e-3, kPressRadius = 0.008;

/// Path of the tip that the hand intends.
Vector3d intended(double t) {
  const auto ramp = [](double x) { return x <= 0 ? 0.0 : x >= 1 ? 1.0 : 0.5 - 0.5 * std::cos(std::numbers::pi * x); };
  double depth = 0.012 * ramp((t - 0.1) / 0.4) - 0.014 * ramp((t - 4.5) / 0.2);
  if (t > 2 && t < 3) depth += 0.003 * std::sin(2 * std::numbers::pi * 4 * (t - 2));
  return {0, 0, kPressRadius + 0.002 - depth};
}

/// Five seconds of the loop: the hand comes down, presses, holds still, shakes for a second, holds still and leaves.
/// The hand feels the full model of the same step if `lock_step`; else the local model, which comes `delay` steps later
/// than it could, claims `stiffer` times the stiffness, and comes no more from step `silent_from` on.
LoopTrace run(Hand hand, double young, double damping, int delay, bool lock_step, double stiffer = 1,
              std::uint64_t silent_from = 5000, bool controller = true) {
  Scene scene = testing::moving_block_scene(kPressRadius);
  scene.passivity.controller = controller;
  const Tool& tool = scene.tools[0];
  HapticStep haptic(scene, std::vector<Archive>(1));
  TouchedBlock block(young, damping);
  hand.at = intended(0);
  haptic.start(std::array{tip_at(tool, hand.at)});
  std::deque<LocalContactModel> on_the_way;
  LoopTrace trace;
  Vector3d before = hand.at;
  for (std::uint64_t k = 0; k < 5000; ++k) {
    while (!on_the_way.empty() && on_the_way.front().tool_step + 1 + delay <= k) {
      EXPECT_TRUE(haptic.consume(on_the_way.front()));
      on_the_way.pop_front();
    }
    const ToolDofs dofs = tip_at(tool, hand.at);
    haptic.step(std::array{dofs});
    block.tick(before, hand.at, kPressRadius, kPeriod);
    if (k < silent_from) on_the_way.push_back(block.describe(dofs, k, stiffer));
    trace.at.push_back(hand.at);
    trace.felt.push_back(lock_step ? Vector3d(-block.force()) : haptic.force(0));
    trace.full.push_back(-block.force());
    before = hand.at;
    hand.move(intended(kPeriod * static_cast<double>(k)), trace.felt.back(), kPeriod);
  }
  return trace;
}

/// Largest and smallest height of the tip [m] between two times, subtracted.
double swing(const LoopTrace& trace, double from, double to) {
  double least = 1, most = -1;
  for (int k = static_cast<int>(from / kPeriod); k < static_cast<int>(to / kPeriod); ++k) {
    least = std::min(least, trace.at[k].z());
    most = std::max(most, trace.at[k].z());
  }
  return most - least;
}

/// How far the local model's force lies from the full model's at the same tool motion [N].
struct ForceError {
  double rms = 0, largest = 0;  ///< over the whole run
  double pressed = 0;           ///< largest once the first touch is 150 ms past, until the tool leaves
  double peak = 0;              ///< largest force of the full model
  double path = 0;              ///< [m] largest distance from the tip's path with the full model in lock step
};

ForceError error_of(const LoopTrace& trace, const LoopTrace& reference) {
  ForceError e;
  std::size_t touched = 0;
  while (trace.full[touched].isZero(0)) ++touched;
  for (std::size_t k = 0; k < trace.at.size(); ++k) {
    const double error = (trace.felt[k] - trace.full[k]).norm();
    e.rms += error * error / static_cast<double>(trace.at.size());
    e.largest = std::max(e.largest, error);
    if (k > touched + 150 && k < 4500) e.pressed = std::max(e.pressed, error);
    e.peak = std::max(e.peak, trace.full[k].norm());
    e.path = std::max(e.path, (trace.at[k] - reference.at[k]).norm());
  }
  e.rms = std::sqrt(e.rms);
  return e;
}

struct Setting {
  const char* name;
  Hand hand;
  double young;
};

// Damping and stiffness of a hand grow several times over with its grip: a loose, a usual and a firm one.
const Setting kSettings[] = {{"loose hand, 5 kPa", {0.1, 2, 100}, 5e3},   {"usual hand, 5 kPa", {0.2, 4, 400}, 5e3},
                             {"firm hand, 5 kPa", {0.3, 10, 1000}, 5e3},  {"loose hand, 20 kPa", {0.1, 2, 100}, 20e3},
                             {"usual hand, 20 kPa", {0.2, 4, 400}, 20e3}, {"firm hand, 20 kPa", {0.3, 10, 1000}, 20e3}};
/// One of them says all that a sanitizer looks for.
std::span<const Setting> settings() {
  return std::span(kSettings).first(kSanitized ? 1 : std::size(kSettings));
}

constexpr double kTissueDamping = 5;  // [1/s]: the block swings for a second by itself

TEST(LocalModelInTheLoop, ItsForceFollowsTheFullModelAndNoSwingGrowsAtAnyDelay) {
  const std::pair<int, double> bounds[] = {
      {0, 0.005}, {1, 0.005}, {5, 0.006}, {20, 0.01}, {50, 0.02}};  // rms, of the peak
  for (const Setting& s : settings()) {
    const LoopTrace reference = run(s.hand, s.young, kTissueDamping, 0, true);
    for (const auto& [delay, bound] : bounds) {
      const LoopTrace trace = run(s.hand, s.young, kTissueDamping, delay, false);
      const ForceError e = error_of(trace, reference);
      fmt::print("| {} | {} | {:.3f} | {:.4f} | {:.2f} | {:.3f} | {:.3f} | {:.2f} |\n", s.name, delay, e.peak, e.rms,
                 100 * e.rms / e.peak, e.pressed, e.largest, 1e3 * e.path);
      SCOPED_TRACE(fmt::format("{}, {} ms", s.name, delay));
      EXPECT_GT(e.peak, 0.5);
      EXPECT_LT(e.rms, bound * e.peak);
      EXPECT_LT(e.pressed, 0.06 * e.peak);
      EXPECT_LT(e.largest, 0.25) << "the full model catches the touched node's mass in one step";
      EXPECT_LT(e.path, 5e-4);
      // Held still twice: the swing dies out, or is below a hundredth of a millimetre to begin with.
      for (const double from : {0.8, 3.0}) {
        const double early = swing(trace, from, from + 0.6), late = swing(trace, from + 0.6, from + 1.2);
        EXPECT_LT(late, std::max(0.5 * early, 1e-5)) << "held from " << from << " s: " << early << " then " << late;
        EXPECT_LT(late, swing(reference, from + 0.6, from + 1.2) + 5e-5);
      }
      for (const Vector3d& f : trace.felt) ASSERT_TRUE(f.allFinite());
    }
  }
}

TEST(LocalModelInTheLoop, AStiffnessTwiceTooLargeOrTooSmallIsStableUpToFiveMilliseconds) {
  for (const Setting& s : settings())
    for (const double factor : {0.5, 2.0})
      for (const int delay : {0, 1, 5}) {
        const LoopTrace trace = run(s.hand, s.young, kTissueDamping, delay, false, factor);
        SCOPED_TRACE(fmt::format("{}, {} ms, stiffness times {}", s.name, delay, factor));
        for (const double from : {0.8, 3.0}) {
          const double early = swing(trace, from, from + 0.6), late = swing(trace, from + 0.6, from + 1.2);
          EXPECT_LT(late, std::max(0.5 * early, 1e-5)) << early << " then " << late;
        }
      }
}

// What makes the test above mean something: without the stiffness the delayed force alone drives the loop.
TEST(LocalModelInTheLoop, WithoutItsStiffnessTheDelayedForceMakesTheHandShake) {
  const Setting& s = kSettings[4];
  const double alone = swing(run(s.hand, s.young, kTissueDamping, 20, false, 0, 5000, false), 1.4, 2);
  const double controlled = swing(run(s.hand, s.young, kTissueDamping, 20, false, 0), 1.4, 2);
  EXPECT_GT(alone, 1e-3);
  EXPECT_LT(controlled, 0.5 * alone) << "the passivity controller takes most of it away, the stiffness all";
  EXPECT_LT(swing(run(s.hand, s.young, kTissueDamping, 20, false, 1), 1.4, 2), 1e-5);
}

TEST(LocalModelInTheLoop, WhenTheModelsStopTheForceFadesAndTheToolComesToRest) {
  const Setting& s = kSettings[1];
  const LoopTrace trace = run(s.hand, s.young, kTissueDamping, 1, false, 1, 1500);
  const int fades = 1500 + 150;
  EXPECT_GT(trace.felt[fades - 5].norm(), 0.5);
  EXPECT_LT(trace.felt[fades + 60].norm(), 1e-12);
  for (int i = fades - 5; i < fades + 60; ++i) EXPECT_LT((trace.felt[i + 1] - trace.felt[i]).norm(), 0.05) << i;
  EXPECT_LT(swing(trace, 1.85, 2), 2e-3);
  for (const Vector3d& f : trace.felt) ASSERT_TRUE(f.allFinite());
}

}  // namespace
}  // namespace palpate
