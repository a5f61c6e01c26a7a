#include "common/tool/safety.hpp"

#include <algorithm>
#include <cmath>

#include "idl/messages.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// A change of a force or torque: what takes away from it, and all else.
struct Change {
  Vector3d fall, rise;
};

Change change_of(const Vector3d& from, const Vector3d& to) {
  const Vector3d change = to - from;
  const double size = from.norm();
  if (!(size > 0)) return {Vector3d::Zero(), change};
  const Vector3d along = from / size;
  const Vector3d fall = -std::clamp(-change.dot(along), 0.0, size) * along;
  return {fall, change - fall};
}

// The share of a change of force and torque together that is no larger than `most` [N].
double share_within(double most, const Vector3d& force, const Vector3d& torque) {
  const double size = std::max(force.norm(), torque.norm() / SafetyChain::kMaxLever);
  return size > most ? most / size : 1;
}

}  // namespace

SafetyChain::SafetyChain(double max_force, double max_force_rate, double dt)
    : max_force_(max_force), max_rise_(max_force_rate * dt), dt_(dt) {}

std::uint32_t SafetyChain::limit(Eigen::Vector3d& force, Eigen::Vector3d& torque) const {
  const double size = std::max(force.norm(), torque.norm() / kMaxLever);
  if (!(size > max_force_) || !std::isfinite(size)) return 0;
  force *= max_force_ / size;
  torque *= max_force_ / size;
  return force_limited;
}

std::uint32_t SafetyChain::apply(Eigen::Vector3d& force, Eigen::Vector3d& torque, bool healthy) {
  Eigen::Map<Eigen::Vector3d> last(state_.force), last_torque(state_.torque);
  std::uint32_t flags = 0;
  if (!healthy || !force.allFinite() || !torque.allFinite()) state_.faulted = 1;
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
  flags |= limit_change(force, torque);
  last = force;
  last_torque = torque;
  return flags;
}

std::uint32_t SafetyChain::limit_change(Vector3d& force, Vector3d& torque) {
  const Eigen::Map<Vector3d> last(state_.force), last_torque(state_.torque);
  const Change of_force = change_of(last, force), of_torque = change_of(last_torque, torque);
  const double rise = share_within(max_rise_, of_force.rise, of_torque.rise);
  const double fall = share_within(kFall * max_rise_, of_force.fall, of_torque.fall);
  if (rise == 1 && fall == 1) return 0;
  force = last + fall * of_force.fall + rise * of_force.rise;
  torque = last_torque + fall * of_torque.fall + rise * of_torque.rise;
  return slew_limited;
}

}  // namespace palpate
