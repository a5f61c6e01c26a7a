#include "common/tool/safety.hpp"

#include <algorithm>
#include <cmath>

#include "idl/messages.hpp"

namespace palpate {

SafetyChain::SafetyChain(double max_force, double max_force_rate, double dt)
    : max_force_(max_force), max_change_(max_force_rate * dt), dt_(dt) {}

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
  const double change = std::max((force - last).norm(), (torque - last_torque).norm() / kMaxLever);
  if (change > max_change_) {
    const double share = max_change_ / change;
    force = last + share * (force - last);
    torque = last_torque + share * (torque - last_torque);
    flags |= slew_limited;
  }
  last = force;
  last_torque = torque;
  return flags;
}

}  // namespace palpate
