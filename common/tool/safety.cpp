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

// A force on its way to what is asked for, and how much of it is left so that the hand is not pushed for too long.
struct HeldOn {
  double wanted, pushed;  // [J] work on the hand in a tick, of what is asked for and of what it gets
  double ticks;           // until all of the change is there
  double size_wanted, size;

  double share(double spare) const {
    const double held_on = pushed - std::max(wanted, 0.0);
    const double to_come = held_on * ticks / 2;  // [J] while the hand goes on so and the rest falls
    const double most = std::min(spare, SafetyChain::kMaxHeldOn);
    double left = to_come > most ? (std::max(wanted, 0.0) + held_on * std::sqrt(most / to_come)) / pushed : 1.0;
    if (spare == 0) left = std::min(left, size_wanted / std::max(size_wanted, size));
    return left;
  }
};

template <class Vector>
void shrink(Vector&& v, double by) {
  const double size = v.norm();
  if (size <= by)
    v.setZero();
  else
    v *= (size - by) / size;
}

}  // namespace

SafetyChain::SafetyChain(double max_force, double max_force_rate, double dt)
    : max_force_(max_force), max_change_(max_force_rate * dt), dt_(dt) {}

std::uint32_t SafetyChain::limit(PortForce& wanted) const {
  std::uint32_t flags = 0;
  if (const double size = size_of(wanted.force, wanted.torque); size > max_force_ && std::isfinite(size)) {
    wanted.force *= max_force_ / size;
    wanted.torque *= max_force_ / size;
    flags = force_limited;
  }
  if (const double most = kHandleLever * max_force_; std::abs(wanted.grip) > most && std::isfinite(wanted.grip)) {
    wanted.grip = std::copysign(most, wanted.grip);
    flags = force_limited;
  }
  return flags;
}

std::uint32_t SafetyChain::apply(PortForce& wanted, const Tick& tick) {
  Eigen::Map<Vector3d> last(state_.force), last_torque(state_.torque);
  if (!tick.healthy || !wanted.force.allFinite() || !wanted.torque.allFinite() || !std::isfinite(wanted.grip))
    state_.faulted = 1;
  if (state_.faulted) {
    ramp_down();
    wanted = {last, last_torque, state_.grip};
    return fault;
  }
  std::uint32_t flags = limit(wanted);
  flags |= limit_change(wanted.force, wanted.torque, tick);
  flags |= limit_change(wanted.grip, tick);
  last = wanted.force;
  last_torque = wanted.torque;
  state_.grip = wanted.grip;
  return flags;
}

void SafetyChain::ramp_down() {
  State& s = state_;
  Eigen::Map<Vector3d> force(s.force), torque(s.torque);
  Eigen::Map<Eigen::Matrix<double, 1, 1>> grip(&s.grip);
  if (s.ramp_force == 0 && s.ramp_torque == 0 && s.ramp_grip == 0)
    s.ramp_force = force.norm(), s.ramp_torque = torque.norm(), s.ramp_grip = grip.norm();
  const double share = dt_ / kRampSeconds;
  shrink(force, s.ramp_force * share);
  shrink(torque, s.ramp_torque * share);
  shrink(grip, s.ramp_grip * share);
}

std::uint32_t SafetyChain::limit_change(Vector3d& force, Vector3d& torque, const Tick& tick) const {
  const Eigen::Map<const Vector3d> last(state_.force), last_torque(state_.torque);
  const Vector3d change = force - last, change_of_torque = torque - last_torque;
  const double ticks = size_of(change, change_of_torque) / max_change_;
  if (!(ticks > 1)) return 0;
  const double size = size_of(force, torque), wanted = work(force, torque, tick.motion);
  force = last + change / ticks;
  torque = last_torque + change_of_torque / ticks;
  const HeldOn held_on{wanted, work(force, torque, tick.motion), ticks, size, size_of(force, torque)};
  const double share = held_on.share(tick.spare);
  force *= share;
  torque *= share;
  return slew_limited;
}

std::uint32_t SafetyChain::limit_change(double& grip, const Tick& tick) const {
  const double wanted = grip, opening = tick.motion.opening, change = wanted - state_.grip;
  const double ticks = std::abs(change) / (kHandleLever * max_change_);
  if (!(ticks > 1)) return 0;
  grip = state_.grip + change / ticks;
  const HeldOn held_on{wanted * opening, grip * opening, ticks, std::abs(wanted), std::abs(grip)};
  grip *= held_on.share(tick.spare);
  return slew_limited;
}

}  // namespace palpate
