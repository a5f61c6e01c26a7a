#include "common/tool/passivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

PassivityGuard::PassivityGuard(const Passivity& settings, std::vector<Port*> ports, double max_force, double dt)
    : controller_(settings.controller),
      reserve_(settings.reserve),
      max_per_shift_(kMaxDamping / (dt * dt)),
      fade_(std::exp(-dt / kMemory)),
      fade_in_debt_(std::exp(-dt / kMemoryInDebt)),
      ports_(std::move(ports)) {
  const double shift = std::min(kMaxAcceleration * dt * dt, max_force > 0 ? settings.reserve / (2 * max_force) : 0.0);
  min_reach_ = {shift, shift / kLever, shift / kLever};
  for (Port* port : ports_) port->reach = min_reach_;
}

void PassivityGuard::observe() {
  const bool in_debt = energy_ < -reserve_ / 2;
  for (Port* port : ports_) {
    const PortForce& f = port->held;
    const PortMotion &m = port->motion, &before = port->last;
    // What has cost energy is not forgotten in motion, and by a hand that rests not so soon.
    const double fade = !in_debt ? fade_ : rests(m) ? fade_in_debt_ : 1.0;
    energy_ -= f.force.dot(m.shift) + f.torque.dot(m.turn) + f.grip * m.opening;
    Port::Reach& r = port->reach;
    r.shift = grown(r.shift, fade, min_reach_.shift, (m.shift - before.shift).norm());
    r.turn = grown(r.turn, fade, min_reach_.turn, (m.turn - before.turn).norm());
    r.opening = grown(r.opening, fade, min_reach_.opening, std::abs(m.opening - before.opening));
    // What goes to and fro from tick to tick is no motion to resist: the next one would come back along it.
    port->resisting = m.shift.dot(before.shift) > 0 ? max_per_shift_ * m.shift.norm() : 0.0;
    port->last = m;
  }
}

bool PassivityGuard::rests(const PortMotion& m) const {
  constexpr double of_reach = 0.1;
  return m.shift.norm() <= of_reach * min_reach_.shift && m.turn.norm() <= of_reach * min_reach_.turn &&
         std::abs(m.opening) <= of_reach * min_reach_.opening;
}

double PassivityGuard::risk(const Port& port) const {
  const PortForce& f = port.asked;
  const Port::Reach& r = port.reach;
  return work(f, port.motion) + f.force.norm() * r.shift + f.torque.norm() * r.turn + std::abs(f.grip) * r.opening;
}

PassivityGuard::Outlook PassivityGuard::outlook() const {
  Outlook sum;
  for (const Port* port : ports_) {
    if (!finite(port->asked)) continue;
    const double r = risk(*port);
    (r > 0 ? sum.risk : sum.income) += std::abs(r);
  }
  return sum;
}

void PassivityGuard::control() {
  for (Port* port : ports_) {
    port->limited = false;
    port->spare = controller_ ? std::max(0.0, energy_ + reserve_ / 2) : std::numeric_limits<double>::infinity();
  }
  if (!controller_) return;
  const double left = energy_ + reserve_, spare = left - kForResisting * reserve_;
  const Outlook before = outlook();
  if (before.risk <= spare + before.income) return;
  const double affordable = affordable_resistance(left);
  for (Port* port : ports_) {
    if (!finite(port->asked) || !(risk(*port) > 0)) continue;
    port->limited = true;
    port->spare = 0;
    port->resisting *= affordable;
    const double along = work(port->asked.force, port->motion.shift);
    // What stands against the motion may go on doing so, and what pushes makes good what has been taken too much.
    const double against = along < 0 ? -along / port->motion.shift.norm() : 0.0;
    if (along <= 0 || left >= 0) port->resisting = std::min(port->resisting, against);
  }
  damp_pushes(before.risk - before.income - spare);
  shrink(spare);
  resist();
}

// A damper d that is turned round within the reach r gives at most d r^2 / 4. After a jump that no one could foresee it
// damps fully.
double PassivityGuard::affordable_resistance(double left) const {
  if (left < 0) return 1;
  double worst = 0;
  for (const Port* port : ports_) {
    const double shift = port->reach.shift;
    worst += max_per_shift_ * shift * shift / 4;
  }
  const double kept = std::min(left, kForResisting * reserve_);
  return worst > kept ? kept / worst : 1;
}

// Takes away what pushes along its motion, as far as energy is missing.
void PassivityGuard::damp_pushes(double missing) {
  double pushed = 0;
  for (const Port* port : ports_)
    if (port->limited && work(port->asked, port->motion) > 0) pushed += push(port->asked, port->motion);
  if (!(pushed > 0)) return;
  const double share = std::min(1.0, missing / pushed);
  for (Port* port : ports_) {
    PortForce& asked = port->asked;
    if (!port->limited || !(work(asked, port->motion) > 0)) continue;
    damp(asked.force, port->motion.shift, share);
    damp(asked.torque, port->motion.turn, share);
    if (work(asked.grip, port->motion.opening) > 0) asked.grip *= 1 - share;
  }
}

// The most that each may risk so that all together risk no more than `in_all`: who risks less keeps his force.
double PassivityGuard::fair_risk(double in_all) const {
  double fair = 0;
  for (bool grows = true; grows;) {
    double left = std::max(0.0, in_all);
    int others = 0;
    for (const Port* port : ports_) {
      const double r = finite(port->asked) ? risk(*port) : 0;
      if (r > fair)
        ++others;
      else
        left -= std::max(0.0, r);
    }
    const double grown = others > 0 ? left / others : fair;
    grows = grown > fair;
    fair = std::max(fair, grown);
  }
  return fair;
}

// Makes the forces so small that even a motion that turns round leaves the energy above -reserve: those first that risk
// most, so that a tool thrown about does not take the force from a hand that rests.
void PassivityGuard::shrink(double spare) {
  const Outlook left = outlook();
  if (left.risk <= spare + left.income) return;
  const double fair = fair_risk(spare + left.income);
  for (Port* port : ports_) {
    const double at_risk = finite(port->asked) ? risk(*port) : 0;
    if (!port->limited || !(at_risk > fair)) continue;
    const double share = fair / at_risk;
    port->asked.force *= share;
    port->asked.torque *= share;
    port->asked.grip *= share;
  }
}

void PassivityGuard::resist() {
  for (Port* port : ports_) {
    if (!port->limited || !(port->resisting > 0)) continue;
    const Eigen::Vector3d along = port->motion.shift.stableNormalized();
    const double now = port->asked.force.dot(along);
    if (now > -port->resisting) port->asked.force -= (now + port->resisting) * along;
  }
}

void PassivityGuard::state(State& s) {
  s.value(energy_);
  for (Port* port : ports_) {
    s.value(port->held.force);
    s.value(port->held.torque);
    s.value(port->held.grip);
    s.value(port->last.shift);
    s.value(port->last.turn);
    s.value(port->last.opening);
    s.value(port->reach.shift);
    s.value(port->reach.turn);
    s.value(port->reach.opening);
  }
}

}  // namespace palpate
