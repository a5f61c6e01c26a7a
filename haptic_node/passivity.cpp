#include "haptic_node/passivity.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace palpate {
namespace {

bool finite(const PortForce& f) { return f.force.allFinite() && f.torque.allFinite() && std::isfinite(f.grip); }

// Work [J] of one part of a port on the hand; 0 for a motion too small to have a direction.
double work(const Eigen::Vector3d& force, const Eigen::Vector3d& motion) {
  return motion.norm() > PassivityGuard::still ? force.dot(motion) : 0;
}
double work(double torque, double motion) { return std::abs(motion) > PassivityGuard::still ? torque * motion : 0; }

double work(const PortForce& f, const PortMotion& m) { return work(f.force, m.shift) + work(f.torque, m.turn) + work(f.grip, m.opening); }

// The same, of the parts that push along their motion alone.
double push(const PortForce& f, const PortMotion& m) {
  return std::max(0.0, work(f.force, m.shift)) + std::max(0.0, work(f.torque, m.turn)) + std::max(0.0, work(f.grip, m.opening));
}

// Takes this share of the component along the motion away, if it pushes.
void damp(Eigen::Vector3d& force, const Eigen::Vector3d& motion, double share) {
  if (!(work(force, motion) > 0)) return;
  const Eigen::Vector3d along = motion.stableNormalized();
  force -= share * force.dot(along) * along;
}

}  // namespace

PortMotion motion_between(const Eigen::Isometry3d& before, const Eigen::Isometry3d& now, double opening) {
  const Eigen::Matrix3d turn = now.linear() * before.linear().transpose();
  // Twice the sine of the angle along the axis: for the small turn of a tick, the rotation vector to third order.
  const Eigen::Vector3d twice(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
  return {now.translation() - before.translation(), 0.5 * twice, opening};
}

PassivityGuard::PassivityGuard(const Passivity& settings, int tools, double most_force, double dt)
    : controller_(settings.controller),
      dt_(dt),
      lowest_(-settings.reserve + std::min(most_force * most_acceleration * dt * dt, settings.reserve / 2)), held_(tools), motion_(tools), limited_(tools, 0) {}

void PassivityGuard::observe(std::span<const PortMotion> motion) {
  std::ranges::copy(motion, motion_.begin());
  for (std::size_t t = 0; t < held_.size(); ++t) {
    const PortForce& f = held_[t];
    energy_ -= f.force.dot(motion[t].shift) + f.torque.dot(motion[t].turn) + f.grip * motion[t].opening;
  }
}

void PassivityGuard::control(std::span<PortForce> asked) {
  std::ranges::fill(limited_, 0);
  if (!controller_) return;
  double taken = 0, pushed = 0;
  for (std::size_t t = 0; t < asked.size(); ++t) {
    if (!finite(asked[t])) continue;
    taken += work(asked[t], motion_[t]);
    if (work(asked[t], motion_[t]) > 0) pushed += push(asked[t], motion_[t]);
  }
  const double missing = lowest_ - (energy_ - taken);
  if (!(missing > 0) || !(pushed > 0)) return;
  const double share = std::min(1.0, missing / pushed);
  for (std::size_t t = 0; t < asked.size(); ++t) {
    if (!finite(asked[t]) || !(work(asked[t], motion_[t]) > 0)) continue;
    limited_[t] = 1;
    damp(asked[t].force, motion_[t].shift, share);
    damp(asked[t].torque, motion_[t].turn, share);
    if (work(asked[t].grip, motion_[t].opening) > 0) asked[t].grip *= 1 - share;
  }
  if (missing > pushed) repay(asked, missing - pushed);
}

void PassivityGuard::repay(std::span<PortForce> asked, double missing) {
  double square = 0;
  for (std::size_t t = 0; t < asked.size(); ++t)
    if (limited_[t]) square += motion_[t].shift.squaredNorm();
  if (!(square > still * still)) return;
  const double per_shift = std::min(missing / square, most_damping / (dt_ * dt_));  // [N/m] on the motion of one tick
  for (std::size_t t = 0; t < asked.size(); ++t)
    if (limited_[t]) asked[t].force -= per_shift * motion_[t].shift;
}

void PassivityGuard::save(unsigned char* to) const {
  const auto put = [&to](const double* from, std::size_t count) {
    std::memcpy(to, from, count * sizeof(double));
    to += count * sizeof(double);
  };
  put(&energy_, 1);
  for (const PortForce& f : held_) {
    put(f.force.data(), 3);
    put(f.torque.data(), 3);
    put(&f.grip, 1);
  }
}

void PassivityGuard::restore(const unsigned char* from) {
  const auto get = [&from](double* to, std::size_t count) {
    std::memcpy(to, from, count * sizeof(double));
    from += count * sizeof(double);
  };
  get(&energy_, 1);
  for (PortForce& f : held_) {
    get(f.force.data(), 3);
    get(f.torque.data(), 3);
    get(&f.grip, 1);
  }
}

}  // namespace palpate
