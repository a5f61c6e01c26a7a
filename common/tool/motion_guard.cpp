#include "common/tool/motion_guard.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kRounding = 1e-9;  // what was followed at the greatest speed passes when it is played again

// A change of pose as two sizes that have bounds.
struct Distance {
  double tip;   // [m] at most that the tip moves
  double turn;  // [rad] of roll or grip
};

Distance distance(const ToolDofs& a, const ToolDofs& b) {
  const double lever = std::max(std::abs(a.depth), std::abs(b.depth));
  return {lever * (std::abs(a.yaw - b.yaw) + std::abs(a.pitch - b.pitch)) + std::abs(a.depth - b.depth),
          std::max(std::abs(a.roll - b.roll), std::abs(a.grip - b.grip))};
}

}  // namespace

bool MotionLimits::allow(const ToolDofs& d) const {
  const auto within = [](double value, double most) { return std::abs(value) <= most; };  // false for what is no number
  return within(d.yaw, max_angle) && within(d.pitch, max_angle) && within(d.roll, kMaxAngle) &&
         within(d.grip, kMaxAngle) && d.depth >= min_depth && d.depth <= max_depth && std::isfinite(d.pedal);
}

bool MotionGuard::close_by(const ToolDofs& a, const ToolDofs& b) const {
  const Distance d = distance(a, b);
  return d.tip <= limits_.jump && d.turn <= limits_.jump_angle;
}

bool MotionGuard::plausible(const ToolDofs& sample) const {
  return limits_.allow(sample) && (close_by(sample, *at_) || (seen_ && close_by(sample, *seen_)));
}

ToolDofs MotionGuard::follow(const ToolDofs& sample, std::uint64_t seq) {
  if (!at_) at_ = seen_ = sample;
  const bool anew = seq == 0 || seq != seq_;
  if (anew) {
    accepted_ = plausible(sample);
    refused_ += !accepted_;
    if (limits_.allow(sample)) seen_ = sample;
    seq_ = seq;
  }
  at_->silent = sample.silent;
  if (!accepted_) return *at_;
  const Distance d = distance(*at_, sample);
  const double share = std::min({1.0, limits_.max_speed * dt_ / d.tip, limits_.max_turn * dt_ / d.turn});
  if (share < 1 - kRounding) {
    ++followed_;
    const auto towards = [share](double& from, double to) { from += share * (to - from); };
    towards(at_->yaw, sample.yaw);
    towards(at_->pitch, sample.pitch);
    towards(at_->depth, sample.depth);
    towards(at_->roll, sample.roll);
    towards(at_->grip, sample.grip);
    at_->pedal = sample.pedal;
  } else {
    at_ = sample;
  }
  return *at_;
}

}  // namespace palpate
