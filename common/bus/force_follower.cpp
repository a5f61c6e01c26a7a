#include "common/bus/force_follower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace palpate {
namespace {

// No number where one of them is none: std::hypot of three passes over one.
double norm(const std::array<double, 3>& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// s a + t b
MotorForce sum(double s, const MotorForce& a, double t, const MotorForce& b) {
  MotorForce c;
  const auto each = [&](const auto& from_a, const auto& from_b, auto& to) {
    for (std::size_t k = 0; k < to.size(); ++k) to[k] = s * from_a[k] + t * from_b[k];
  };
  each(a.force, b.force, c.force);
  each(a.torque, b.torque, c.torque);
  each(a.along, b.along, c.along);
  c.grip = s * a.grip + t * b.grip;
  return c;
}

}  // namespace

ForceFollower::ForceFollower(std::uint32_t tool, const MotorLimits& limits) : tool_(tool), limits_(limits) {
  const auto& [force, torque, grip, force_rate] = limits;
  for (const auto& [name, limit] :
       {std::pair{"max_force", force}, {"max_torque", torque}, {"max_grip", grip}, {"max_force_rate", force_rate}})
    if (!(limit > 0 && std::isfinite(limit)))
      throw std::runtime_error(
          fmt::format("{}: what a device's motors give is a finite number above 0, not {}", name, limit));
}

// [N] of all together, by the proportion of the limits; infinite where one of them is no number.
double ForceFollower::size(const MotorForce& f) const {
  const auto& [yaw, pitch, depth, roll] = f.along;
  const double per_torque = limits_.max_force / limits_.max_torque, per_grip = limits_.max_force / limits_.max_grip;
  const std::array newtons{norm(f.force), per_torque * norm(f.torque), std::abs(depth),
                           per_torque * norm({yaw, pitch, roll}), per_grip * std::abs(f.grip)};
  const bool finite = std::ranges::all_of(newtons, [](double n) { return std::isfinite(n); });
  return finite ? std::ranges::max(newtons) : std::numeric_limits<double>::infinity();
}

bool ForceFollower::hear(const ForceState& told, std::int64_t now_ns) {
  if (told.tool != tool_) return false;
  if (follows_ && told.run != run_) return ++strange_, false;
  const MotorForce force{
      told.force, told.torque, {told.yaw_torque, told.pitch_torque, told.depth_force, told.roll_torque}, told.grip};
  const double newtons = size(force);
  if (!(newtons <= kAbsurd * limits_.max_force)) return ++refused_, false;
  told_ = sum(newtons > limits_.max_force ? limits_.max_force / newtons : 1, force, 0, {});
  catches_up_ |= told.step > step_ + kMissed;
  step_ = told.step;
  follows_ = true;
  run_ = told.run;
  heard_ns_ = now_ns;
  return true;
}

const MotorForce& ForceFollower::give(std::int64_t now_ns) {
  const double dt = std::clamp(1e-9 * static_cast<double>(now_ns - given_ns_), 0.0, kLongestTick);
  given_ns_ = now_ns;
  const bool silent = !follows_ || 1e-9 * static_cast<double>(now_ns - heard_ns_) > kSilence;
  share_ = std::clamp(share_ + dt / (silent ? -kFade : kReturn), 0.0, 1.0);
  if (silent && limp()) follows_ = false;
  const MotorForce wanted = sum(share_, told_, 0, {});
  const double before = size(given_), after = size(wanted);
  const double falls = after < before && !catches_up_ ? after / before : 1;
  const MotorForce change = sum(1, wanted, -falls, given_);
  const double ticks = size(change) / (limits_.max_force_rate * dt);  // until all of it is there
  catches_up_ &= ticks > 1;
  const double share = ticks > 1 ? 1 / ticks : 1;
  return given_ = sum(falls, given_, share, change);
}

}  // namespace palpate
