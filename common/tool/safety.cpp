#include "common/tool/safety.hpp"

#include <algorithm>
#include <cmath>

#include "idl/messages.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// [J] on the hand while it makes such a motion once more.
double work(const Vector3d& force, const Vector3d& torque, const PortMotion& motion) {
  return force.dot(motion.shift) + torque.dot(motion.turn);
}

// [N] of force and torque together.
double size_of(const Vector3d& force, const Vector3d& torque) {
  return std::max(force.norm(), torque.norm() / SafetyChain::kMaxLever);
}

}  // namespace

SafetyChain::SafetyChain(double max_force, double max_force_rate, double dt)
    : max_force_(max_force), max_change_(max_force_rate * dt), dt_(dt) {}

std::uint32_t SafetyChain::limit(Eigen::Vector3d& force, Eigen::Vector3d& torque) const {
  const double size = size_of(force, torque);
  if (!(size > max_force_) || !std::isfinite(size)) return 0;
  force *= max_force_ / size;
  torque *= max_force_ / size;
  return force_limited;
}

std::uint32_t SafetyChain::apply(Eigen::Vector3d& force, Eigen::Vector3d& torque, const Tick& tick) {
  Eigen::Map<Eigen::Vector3d> last(state_.force), last_torque(state_.torque);
  std::uint32_t flags = 0;
  if (!tick.healthy || !force.allFinite() || !torque.allFinite()) state_.faulted = 1;
  if (state_.faulted) {
    if (state_.ramp_force == 0 && state_.ramp_torque == 0) {
      state_.ramp_force = last.norm();
      state_.ramp_torque = last_torque.norm();
    }
    const double share = dt_ / kRampSeconds;
    const auto shrink = [](Eigen::Map<Eigen::Vector3d>& v, double by) {
      const double size = v.norm();
      if (size <= by)
        v.setZero();
      else
        v *= (size - by) / size;
    };
    shrink(last, state_.ramp_force * share);
    shrink(last_torque, state_.ramp_torque * share);
    force = last;
    torque = last_torque;
    return fault;
  }
  flags |= limit(force, torque);
  flags |= limit_change(force, torque, tick);
  last = force;
  last_torque = torque;
  return flags;
}

std::uint32_t SafetyChain::limit_change(Vector3d& force, Vector3d& torque, const Tick& tick) {
  const Eigen::Map<Vector3d> last(state_.force), last_torque(state_.torque);
  const Vector3d change = force - last, change_of_torque = torque - last_torque;
  const double ticks = size_of(change, change_of_torque) / max_change_;  // until all of it is there
  if (!(ticks > 1)) return 0;
  const double size = size_of(force, torque), wanted = std::max(work(force, torque, tick.motion), 0.0);
  force = last + change / ticks;
  torque = last_torque + change_of_torque / ticks;
  const double pushed = work(force, torque, tick.motion), held_on = pushed - wanted;
  const double to_come = held_on * ticks / 2;  // [J] while the hand goes on so and the rest falls
  const double most = std::min(tick.spare, kMaxHeldOn);
  double left = to_come > most ? (wanted + held_on * std::sqrt(most / to_come)) / pushed : 1.0;
  if (tick.spare == 0) left = std::min(left, size / std::max(size, size_of(force, torque)));
  force *= left;
  torque *= left;
  return slew_limited;
}

}  // namespace palpate
