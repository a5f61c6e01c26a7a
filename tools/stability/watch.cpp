#include "tools/stability/watch.hpp"

#include <fmt/format.h>

#include <cmath>

namespace palpate::stability {

void Watch::look(const HapticStep& haptic) {
  ++steps_;
  std::uint32_t flags = 0;
  for (int t = 0; t < haptic.tools(); ++t) {
    flags |= haptic.flags(t);
    torque_ = larger(torque_, haptic.torque(t).norm());
    finite_ &= std::isfinite(haptic.grip_torque(t));
    largest_ = larger(largest_, haptic.force(t).norm());
  }
  max_lost_ = larger(max_lost_, -haptic.energy());
  regularised_ += (flags & regularised) != 0;
  limited_ += (flags & force_limited) != 0;
  slewed_ += (flags & slew_limited) != 0;
  faults_ += (flags & fault) != 0;
  stale_ += (flags & stale_model) != 0;
  damped_ += (flags & passivity_limited) != 0;
}

Result Watch::result() const {
  Result r{.max_force = largest_, .energy_growth = max_lost_, .note = {}};
  const auto say = [&](int count, const char* what) {
    if (count == 0) return;
    r.outcome = Outcome::regularised;
    r.note += fmt::format("{}{} in {} of {} steps", r.note.empty() ? "" : ", ", what, count, steps_);
  };
  say(regularised_, "contacts softened");
  say(limited_, "force limited");
  say(slewed_, "slew limited");
  say(damped_, "damped for passivity");
  say(stale_, "faded for want of a model");
  say(faults_, "fault, force ramped to zero,");
  if (torque_ > kMaxTorque) {
    r.outcome = Outcome::failed;
    r.note += fmt::format("{}torque up to {:.3g} N m", r.note.empty() ? "" : ", ", torque_);
  }
  if (!finite_ || !std::isfinite(torque_))
    r = {.outcome = Outcome::failed, .note = "a force is not a number; " + r.note};
  return r;
}

void TissueWatch::look(const DynamicOrgan& organ) {
  for (const Eigen::Vector3d& x : organ.surface().positions()) reach_ = larger(reach_, x.norm());
  largest_ = larger(largest_, force_on_moving_part(organ).norm());
  double& most = ++ticks_ <= 200 ? first_energy_ : late_energy_;
  most = larger(most, organ.model().energy());
}

Result TissueWatch::result() const {
  Result r{.max_force = largest_,
           .energy_growth = larger(late_energy_ - first_energy_, 0),
           .note = "energy is the tissue's own"};
  if (!(reach_ <= 1e3)) r = {.outcome = Outcome::failed, .note = "the tissue's shape is not a number or runs away"};
  return r;
}

void CatheterWatch::look(const CatheterBody& body) {
  for (const CatheterToolForce& f : body.tool_forces()) force_ = larger(force_, f.force.norm());
  for (const Eigen::Vector3d& x : body.positions()) reach_ = larger(reach_, x.norm());
}

Result CatheterWatch::result(double energy_growth) const {
  Result r{.max_force = force_,
           .energy_growth = energy_growth,
           .note = fmt::format("energy is the catheter's own; reach {:.3g} m", reach_)};
  if (!std::isfinite(force_) || !(reach_ <= 10)) r.outcome = Outcome::failed;
  return r;
}

}  // namespace palpate::stability
