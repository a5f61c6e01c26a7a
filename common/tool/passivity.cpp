#include "common/tool/passivity.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace palpate {
namespace {

bool finite(const PortForce& f) {
  return f.force.allFinite() && f.torque.allFinite() && std::isfinite(f.grip);
}

// Work [J] of one part of a port on the hand; 0 for a motion too small to have a direction.
double work(const Eigen::Vector3d& force, const Eigen::Vector3d& motion) {
  return motion.norm() > PassivityGuard::kStill ? force.dot(motion) : 0;
}
double work(double torque, double motion) {
  return std::abs(motion) > PassivityGuard::kStill ? torque * motion : 0;
}

double work(const PortForce& f, const PortMotion& m) {
  return work(f.force, m.shift) + work(f.torque, m.turn) + work(f.grip, m.opening);
}

// The same, of the parts that push along their motion alone.
double push(const PortForce& f, const PortMotion& m) {
  return std::max(0.0, work(f.force, m.shift)) + std::max(0.0, work(f.torque, m.turn)) +
         std::max(0.0, work(f.grip, m.opening));
}

// Takes this share of the component along the motion away, if it pushes.
void damp(Eigen::Vector3d& force, const Eigen::Vector3d& motion, double share) {
  if (!(work(force, motion) > 0)) return;
  const Eigen::Vector3d along = motion.stableNormalized();
  force -= share * force.dot(along) * along;
}

// A reach after a change of motion was seen. So large a change that no hand makes it is a tool set elsewhere: nothing
// to expect again.
double grown(double reach, double fade, double least, double change) {
  constexpr double max_steps = 30;
  return std::max({least, fade * reach, change < max_steps * least ? change : 0.0});
}

}  // namespace

PortMotion motion_between(const Eigen::Isometry3d& before, const Eigen::Isometry3d& now, double opening) {
  const Eigen::Matrix3d turn = now.linear() * before.linear().transpose();
  // Twice the sine of the angle along the axis: for the small turn of a tick, the rotation vector to third order.
  const Eigen::Vector3d twice(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
  return {now.translation() - before.translation(), 0.5 * twice, opening};
}

PassivityGuard::PassivityGuard(const Passivity& settings, int tools, double max_force, double slew, double dt)
    : controller_(settings.controller),
      reserve_(settings.reserve),
      slew_(slew * dt),
      max_per_shift_(kMaxDamping / (dt * dt)),
      fade_(std::exp(-dt / kMemory)),
      held_(tools),
      motion_(tools),
      resisting_(tools, 0.0),
      limited_(tools, 0) {
  const double shift = std::min(kMaxAcceleration * dt * dt, max_force > 0 ? settings.reserve / (2 * max_force) : 0.0);
  min_reach_ = {shift, shift / kLever, shift / kLever};
  reach_.assign(tools, min_reach_);
}

void PassivityGuard::observe(std::span<const PortMotion> motion) {
  // What has cost energy is not forgotten until it is paid.
  const double fade = energy_ < -reserve_ / 2 ? 1.0 : fade_;
  for (std::size_t t = 0; t < held_.size(); ++t) {
    const PortForce& f = held_[t];
    const PortMotion &m = motion[t], &before = motion_[t];
    energy_ -= f.force.dot(m.shift) + f.torque.dot(m.turn) + f.grip * m.opening;
    Reach& r = reach_[t];
    r.shift = grown(r.shift, fade, min_reach_.shift, (m.shift - before.shift).norm());
    r.turn = grown(r.turn, fade, min_reach_.turn, (m.turn - before.turn).norm());
    r.opening = grown(r.opening, fade, min_reach_.opening, std::abs(m.opening - before.opening));
    // What goes to and fro from tick to tick is no motion to resist: the next one would come back along it.
    resisting_[t] = m.shift.dot(before.shift) > 0 ? max_per_shift_ * m.shift.norm() : 0.0;
    motion_[t] = m;
  }
}

double PassivityGuard::risk(int tool, const PortForce& f) const {
  const Reach& r = reach_[tool];
  const double size = f.force.norm();
  const double next = work(f, motion_[tool]) + size * r.shift + f.torque.norm() * r.turn + std::abs(f.grip) * r.opening;
  return next > 0 ? next * (1 + size / (2 * slew_)) : next;
}

PassivityGuard::Outlook PassivityGuard::outlook(std::span<const PortForce> asked) const {
  Outlook sum;
  for (std::size_t t = 0; t < asked.size(); ++t) {
    if (!finite(asked[t])) continue;
    const double r = risk(static_cast<int>(t), asked[t]);
    (r > 0 ? sum.risk : sum.income) += std::abs(r);
  }
  return sum;
}

void PassivityGuard::control(std::span<PortForce> asked) {
  std::ranges::fill(limited_, 0);
  if (!controller_) return;
  const double left = energy_ + reserve_, spare = left - kForResisting * reserve_;
  const Outlook before = outlook(asked);
  if (before.risk <= spare + before.income) return;
  const double affordable = affordable_resistance(left);
  for (std::size_t t = 0; t < asked.size(); ++t) {
    if (!finite(asked[t]) || !(risk(static_cast<int>(t), asked[t]) > 0)) continue;
    limited_[t] = 1;
    resisting_[t] *= affordable;
    const double along = work(asked[t].force, motion_[t].shift);
    // What stands against the motion may go on doing so, and what pushes makes good what has been taken too much.
    const double against = along < 0 ? -along / motion_[t].shift.norm() : 0.0;
    if (along <= 0 || left >= 0) resisting_[t] = std::min(resisting_[t], against);
  }
  damp_pushes(asked, before.risk - before.income - spare);
  shrink(asked, spare);
  resist(asked);
}

// A damper d that is turned round within the reach r gives at most d r^2 / 4. After a jump that no one could foresee it
// damps fully.
double PassivityGuard::affordable_resistance(double left) const {
  if (left < 0) return 1;
  double worst = 0;
  for (const Reach& r : reach_)
    worst += max_per_shift_ * r.shift * r.shift / 4 * (1 + max_per_shift_ * r.shift / (2 * slew_));
  const double kept = std::min(left, kForResisting * reserve_);
  return worst > kept ? kept / worst : 1;
}

// Takes away what pushes along its motion, as far as energy is missing.
void PassivityGuard::damp_pushes(std::span<PortForce> asked, double missing) {
  double pushed = 0;
  for (std::size_t t = 0; t < asked.size(); ++t)
    if (limited_[t] && work(asked[t], motion_[t]) > 0) pushed += push(asked[t], motion_[t]);
  if (!(pushed > 0)) return;
  const double share = std::min(1.0, missing / pushed);
  for (std::size_t t = 0; t < asked.size(); ++t) {
    if (!limited_[t] || !(work(asked[t], motion_[t]) > 0)) continue;
    damp(asked[t].force, motion_[t].shift, share);
    damp(asked[t].torque, motion_[t].turn, share);
    if (work(asked[t].grip, motion_[t].opening) > 0) asked[t].grip *= 1 - share;
  }
}

// Makes the forces so small that even a motion that turns round leaves the energy above -reserve.
void PassivityGuard::shrink(std::span<PortForce> asked, double spare) {
  const Outlook left = outlook(asked);
  if (left.risk <= spare + left.income) return;
  const double share = std::max(0.0, (spare + left.income) / left.risk);
  for (std::size_t t = 0; t < asked.size(); ++t) {
    if (!limited_[t] || !(risk(static_cast<int>(t), asked[t]) > 0)) continue;
    asked[t].force *= share;
    asked[t].torque *= share;
    asked[t].grip *= share;
  }
}

void PassivityGuard::resist(std::span<PortForce> asked) {
  for (std::size_t t = 0; t < asked.size(); ++t) {
    if (!limited_[t] || !(resisting_[t] > 0)) continue;
    const Eigen::Vector3d along = motion_[t].shift.stableNormalized();
    const double now = asked[t].force.dot(along);
    if (now > -resisting_[t]) asked[t].force -= (now + resisting_[t]) * along;
  }
}

void PassivityGuard::state(State& s) {
  s.value(energy_);
  for (std::size_t t = 0; t < held_.size(); ++t) {
    s.value(held_[t].force);
    s.value(held_[t].torque);
    s.value(held_[t].grip);
    s.value(motion_[t].shift);
    s.value(motion_[t].turn);
    s.value(motion_[t].opening);
    s.value(reach_[t].shift);
    s.value(reach_[t].turn);
    s.value(reach_[t].opening);
  }
}

}  // namespace palpate
