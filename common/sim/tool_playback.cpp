#include "common/sim/tool_playback.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kNothing = 1e-9;   // [m] or [rad]
constexpr double kPaceTicks = 100;  // over which the steps of a tick are averaged
constexpr double kTooSlow = 1.1;    // steps a tick from which on a tissue is too slow, as its warning says

}  // namespace

ToolPlayback::Values ToolPlayback::values(const ToolState& s) {
  return {s.yaw, s.pitch, s.depth, s.roll, s.grip, s.opening};
}

void ToolPlayback::begin(const ToolState& state) {
  *this = {};
  newest_ = now_ = values(state);
  step_ = state.step;
  pedal_ = state.pedal;
}

ToolPlayback::Values ToolPlayback::place(double along) const {
  Values at = newest_;
  for (std::size_t i = 0; along != 0 && i < at.size(); ++i) at[i] += along * pace_[i];
  return at;
}

// What comes after a silence, or all at once, says nothing of the tissue's pace.
double ToolPlayback::steps_in_tick(std::uint64_t arrived) {
  const double counted = std::min(static_cast<double>(arrived), kMaxStepsPerTick);
  steps_per_tick_ += (counted - steps_per_tick_) / kPaceTicks;
  return steps_per_tick_ > kTooSlow ? steps_per_tick_ : 1;
}

void ToolPlayback::tick(const ToolState* arrived, std::uint64_t left_out) {
  const std::uint64_t came = arrived && arrived->step > step_ ? arrived->step - step_ : 0;
  const double steps_now = steps_in_tick(came);
  const double ahead = std::max<double>(kAhead, steps_now);
  along_ = std::min(along_ + steps_now, ahead);
  for (double& m : missed_) m = std::abs(m) < kNothing ? 0 : (1 - 1 / kMakeUpTicks) * m;
  if (came > 0) {
    const Values expected = place(along_), next = values(*arrived);
    const auto steps = static_cast<double>(came + left_out);
    for (std::size_t i = 0; i < next.size(); ++i) pace_[i] = (next[i] - newest_[i]) / steps;
    newest_ = next;
    step_ = arrived->step;
    pedal_ = arrived->pedal;
    along_ -= steps;
    if (along_ < -ahead) {
      along_ = 0;
      for (std::size_t i = 0; i < next.size(); ++i) missed_[i] += expected[i] - next[i];
    }
    along_ -= along_ / kMakeUpTicks;
  }
  now_ = place(along_);
  for (std::size_t i = 0; i < now_.size(); ++i)
    if (missed_[i] != 0) now_[i] += missed_[i];
  if (std::ranges::all_of(now_, [](double v) { return std::isfinite(v); })) return;
  pace_ = missed_ = {};
  along_ = 0;
  now_ = newest_;
}

ToolDofs ToolPlayback::dofs() const {
  return {now_[0], now_[1], now_[2], now_[3], now_[4], pedal_};
}

double ToolPlayback::behind() const {
  const double turned = std::abs(missed_[0]) + std::abs(missed_[1]);
  return turned * std::abs(newest_[2]) + std::abs(missed_[2]);
}

void ToolPlayback::state(State& s) {
  s.value(newest_);
  s.value(pace_);
  s.value(missed_);
  s.value(now_);
  s.value(step_);
  s.value(along_);
  s.value(steps_per_tick_);
  s.value(pedal_);
}

}  // namespace palpate
