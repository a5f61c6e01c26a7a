#include "tests/hostile/felt_force.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::testing {
namespace {

constexpr std::int64_t kPeriodNs = 1'000'000, kLateNs = 500'000;

}  // namespace

void FeltForce::add(const ForceState& force) {
  const Eigen::Vector3d now = vector(force), before = newest();
  finite_ = finite_ && now.allFinite() && std::isfinite(force.torque[0] + force.torque[1] + force.torque[2]);
  max_force_ = std::max(max_force_, now.norm());
  const double share = undisturbed_.isZero(0) ? 0 : now.dot(undisturbed_) / undisturbed_.squaredNorm();
  max_off_ = std::max(max_off_, (now - std::clamp(share, 0.0, 1.0) * undisturbed_).norm());
  if (first_ && force.step > newest_.step) {
    const auto steps = static_cast<double>(force.step - newest_.step);
    max_rise_ = std::max(max_rise_, (now.norm() - before.norm()) / steps);
    max_change_ = std::max(max_change_, (now - before).norm() / steps);
    const std::int64_t lost =
        force.sense_ns - newest_.sense_ns - static_cast<std::int64_t>(force.step - newest_.step) * kPeriodNs;
    if (lost > kLateNs) late_.push_back({newest_.sense_ns, force.sense_ns, lost});
  }
  newest_ = force;
  if (!first_) first_ = force;
}

void FeltForce::begin_anew() {
  first_.reset();
  late_.clear();
  max_force_ = max_rise_ = max_change_ = max_off_ = 0;
}

}  // namespace palpate::testing
