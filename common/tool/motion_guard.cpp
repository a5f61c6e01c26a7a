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

bool close_by(const ToolDofs& a, const ToolDofs& b) {
  const Distance d = distance(a, b);
  return d.tip <= MotionGuard::kJump && d.turn <= MotionGuard::kJumpAngle;
}

}  // namespace

bool MotionGuard::in_range(const ToolDofs& d) {
  const auto within = [](double value, double most) { return std::abs(value) <= most; };  // false for what is no number
  return within(d.yaw, kMaxAngle) && within(d.pitch, kMaxAngle) && within(d.roll, kMaxAngle) &&
         within(d.grip, kMaxAngle) && within(d.depth, kMaxDepth) && std::isfinite(d.pedal);
}

bool MotionGuard::plausible(const ToolDofs& sample) const {
  return in_range(sample) && (close_by(sample, *at_) || (seen_ && close_by(sample, *seen_)));
}

ToolDofs MotionGuard::follow(const ToolDofs& sample, std::uint64_t seq) {
  if (!at_) at_ = seen_ = sample;
  const bool anew = seq == 0 || seq != seq_;
  if (anew) {
    accepted_ = plausible(sample);
    refused_ += !accepted_;
    if (in_range(sample)) seen_ = sample;
    seq_ = seq;
  }
  at_->silent = sample.silent;
  if (!accepted_) return *at_;
  const Distance d = distance(*at_, sample);
  const double share = std::min({1.0, kMaxSpeed * dt_ / d.tip, kMaxTurn * dt_ / d.turn});
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
