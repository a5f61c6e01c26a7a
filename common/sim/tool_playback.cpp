#include "common/sim/tool_playback.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kNothing = 1e-9;                              // [m] or [rad]
constexpr double kPaceTicks = 100;                             // over which the steps of a tick are averaged
constexpr double kDecay = 2.146 / ToolPlayback::kMakeUpTicks;  // of critical damping: (1 + 2.146) exp(-2.146) = 1/e
constexpr double kTooSlow = 1.1;  // steps a tick from which on a tissue is too slow, as its warning says

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

// As a critically damped spring would, so that the speed has no jump.
void ToolPlayback::make_up() {
  for (std::size_t i = 0; i < missed_.size(); ++i) {
    drift_[i] -= 2 * kDecay * drift_[i] + kDecay * kDecay * missed_[i];
    missed_[i] += drift_[i];
    if (std::abs(missed_[i]) < kNothing && std::abs(drift_[i]) < kNothing) missed_[i] = drift_[i] = 0;
  }
}

// A loop that stood or was late says where its hand is then, and not how fast it was. Where more has been missed than
// is played back, or that, the tool goes on from where it is and as fast as it is.
void ToolPlayback::take(const ToolState& arrived, double came, double periods, double steps_now) {
  const Values expected = place(along_), next = values(arrived);
  const bool even = periods <= 0 || std::abs(periods - came) <= kUneven;
  for (std::size_t i = 0; even && i < next.size(); ++i) pace_[i] = (next[i] - newest_[i]) / came;
  newest_ = next;
  along_ -= even ? came : periods;
  const bool too_far = along_ < -std::max<double>(kAhead, steps_now);
  if (too_far) along_ = 0;
  const Values told = place(along_);
  for (std::size_t i = 0; (too_far || !even) && i < next.size(); ++i) {
    drift_[i] = expected[i] + missed_[i] - now_[i] - steps_now * pace_[i];
    missed_[i] += expected[i] - told[i];
  }
  along_ -= along_ / kMakeUpTicks;
}

void ToolPlayback::tick(const ToolState* arrived, double periods) {
  const std::uint64_t came = arrived && arrived->step > step_ ? arrived->step - step_ : 0;
  const double steps_now = steps_in_tick(came);
  const double beyond = along_ + steps_now - std::max<double>(kAhead, steps_now);
  along_ += steps_now * std::clamp(1 - beyond / (kFade * std::max(1.0, steps_now)), 0.0, 1.0);
  make_up();
  if (came > 0) {
    take(*arrived, static_cast<double>(came), periods, steps_now);
    step_ = arrived->step;
    pedal_ = arrived->pedal;
  }
  now_ = place(along_);
  for (std::size_t i = 0; i < now_.size(); ++i)
    if (missed_[i] != 0) now_[i] += missed_[i];
  if (std::ranges::all_of(now_, [](double v) { return std::isfinite(v); })) return;
  pace_ = missed_ = drift_ = {};
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
  s.value(drift_);
  s.value(now_);
  s.value(step_);
  s.value(along_);
  s.value(steps_per_tick_);
  s.value(pedal_);
}

}  // namespace palpate
