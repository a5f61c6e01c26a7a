#include "common/tool/hand_motion.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kCarries = 0.04;  // [s] time constant with which what led the tool before does so still
constexpr double kMeets = 0.15;    // [s] after that, over which it is led up to where somebody wants it

// Of a way to its end, in a step.
double share_of(double dt, double time_constant) {
  return 1 - std::exp(-dt / time_constant);
}

}  // namespace

// [1] Within the bounds.
double HandMotion::steps_for(const PoseValues& from, const PoseValues& to) const {
  const double lever = std::max(std::abs(from[2]), std::abs(to[2]));
  const double tip = lever * (std::abs(to[0] - from[0]) + std::abs(to[1] - from[1])) + std::abs(to[2] - from[2]);
  const double turn = std::max(std::abs(to[3] - from[3]), std::abs(to[4] - from[4]));
  return std::max(tip / bounds_.speed, turn / bounds_.turn) / dt_;
}

void HandMotion::stand(const ToolDofs& at) {
  led_ = first_ = smooth_ = pose_values(at);
  carried_.fill(0);
  left_ = meeting_ = 0;
  pedal_ = at.pedal;
}

// The filter's stages are as far ahead as they would be after so even a motion.
void HandMotion::follow(const ToolDofs& at) {
  const PoseValues before = smooth_;
  const int meeting = meeting_;
  stand(at);
  const double ahead = 1 / share_of(dt_, kSmoothing) - 1, within = std::max(1.0, steps_for(before, smooth_));
  for (std::size_t i = 0; i < smooth_.size(); ++i) {
    carried_[i] = (smooth_[i] - before[i]) / within;
    first_[i] += ahead * carried_[i];
    led_[i] += 2 * ahead * carried_[i];
  }
  meeting_ = smooth_ == before ? std::max(0, meeting - 1) : static_cast<int>(std::lround(kMeets / dt_));
}

void HandMotion::aim(const ToolDofs& target) {
  const PoseValues to = pose_values(target);
  pedal_ = target.pedal;
  PoseValues from = led_;
  for (std::size_t i = 0; i < from.size(); ++i) from[i] += carried_[i] / share_of(dt_, kCarries);
  const double steps = std::max({bounds_.delay / dt_, steps_for(from, to), static_cast<double>(meeting_)});
  left_ = std::max(1, static_cast<int>(std::ceil(steps - 1e-9)));
  for (std::size_t i = 0; i < to.size(); ++i) pace_[i] = (to[i] - from[i]) / left_;
}

ToolDofs HandMotion::step() {
  const double share = share_of(dt_, kSmoothing), rests = share_of(dt_, kCarries);
  for (std::size_t i = 0; i < led_.size(); ++i) {
    led_[i] += carried_[i];
    carried_[i] -= rests * carried_[i];
    if (left_ > 0) led_[i] += pace_[i];
    first_[i] += share * (led_[i] - first_[i]);
    smooth_[i] += share * (first_[i] - smooth_[i]);
  }
  left_ = std::max(0, left_ - 1);
  meeting_ = std::max(0, meeting_ - 1);
  return dofs_of(smooth_, pedal_);
}

}  // namespace palpate
