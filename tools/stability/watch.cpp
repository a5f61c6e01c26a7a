#include "tools/stability/watch.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tools/stability/stand_judge.hpp"

namespace palpate::stability {
namespace {

constexpr double kLoose = 3 + StandJudge::kReach;  // [1] of the diagonal: as far as parts that float are followed
constexpr double kNoEnergy = 1e-12;                // [J] is rounding

}  // namespace

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

Result Watch::result(double reserve) const {
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
  if (max_lost_ > reserve) {
    r.outcome = Outcome::failed;
    r.note += fmt::format("{}the hand gained more than the reserve of {:g} J", r.note.empty() ? "" : ", ", reserve);
  }
  if (!finite_ || !std::isfinite(torque_))
    r = {.outcome = Outcome::failed, .note = "a force is not a number; " + r.note};
  return r;
}

double reach_of(const DynamicOrgan& organ) {
  double reach = 0;
  for (int n = 0; n < organ.mesh().nodes(); ++n)
    if (organ.topology().has_node(n)) reach = larger(reach, organ.displacement(n).norm());
  return reach;
}

double work_on(const DynamicWorld& tissue, int organ) {
  double work = 0;
  const auto add = [&](const TouchContact& c, const Eigen::Vector3d& force) {
    const ToolPoint& by = c.tool_point();
    const MovingTool& tool = tissue.in_tick(by.tool).moving;
    const Eigen::Vector3d before = c.grasped ? tool.before * (tool.now.inverse() * c.at)
                                             : tool.to_world_before(by.part, tool.to_part(by.part, c.at));
    work += force.dot(c.at - before);
  };
  for (const TouchContact& c : tissue.organ(organ).contacts()) add(c, c.force);
  if (const CondensedTouch* still = tissue.organ(organ).condensed_part())
    for (std::size_t c = 0; c < still->contacts().size(); ++c)
      add(still->contacts()[c], still->force(static_cast<int>(c)));
  return work;
}

void TissueWatch::look(const DynamicOrgan& organ, double work) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : organ.mesh().rest) box.extend(x);
  diagonal_ = box.diagonal().norm();
  reach_ = larger(reach_, reach_of(organ));
  whole_ &= organ.removed().empty();
  largest_ = larger(largest_, force_on_moving_part(organ).norm());
  work_ += work;
  max_work_ = larger(max_work_, work_);
  gained_ = larger(gained_, organ.model().energy() - work_);
}

Result TissueWatch::result() const {
  Result r{.max_force = largest_, .energy_growth = gained_, .note = "energy is the tissue's beyond the work"};
  judge(r, true);
  return r;
}

void TissueWatch::judge(Result& row, bool energy) const {
  hold(row, "reach over the diagonal", reach_ / diagonal_, whole_ ? StandJudge::kReach : kLoose);
  if (energy)
    hold(row, "energy beyond the work, of it", gained_ > kNoEnergy ? gained_ / max_work_ : 0, StandJudge::kEnergy);
}

void CatheterWatch::look(const CatheterBody& body) {
  for (const CatheterToolForce& f : body.tool_forces()) force_ = larger(force_, f.force.norm());
  for (const Eigen::Vector3d& x : body.positions()) reach_ = larger(reach_, x.norm());
}

Result CatheterWatch::result(double energy_growth) const {
  Result r{.max_force = force_,
           .energy_growth = energy_growth,
           .note = fmt::format("energy is the catheter's own; reach {:.3g} m", reach_)};
  if (!std::isfinite(force_) || !(reach_ <= kReach)) r.outcome = Outcome::failed;
  return r;
}

}  // namespace palpate::stability
