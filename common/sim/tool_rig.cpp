#include "common/sim/tool_rig.hpp"

#include <algorithm>

#include "common/geometry/segment.hpp"
#include "common/tool/fade.hpp"
#include "common/tool/instrument.hpp"
#include "idl/messages.hpp"

namespace palpate {
namespace {

constexpr double kSkin = 2;  // radii of a part within which what it touches lies

double jaw_length(const EndAbilities& can) {
  return can.closing ? can.closing->length : can.turning ? can.turning->length : 0.0;
}

}  // namespace

ToolRig::ToolRig(int index, const Tool& tool, double dt)
    : name_(tool.name),
      trocar_(make_trocar(tool.pivot, tool.axis, tool.up)),
      shaft_length_(tool.shaft_length),
      jaw_length_(jaw_length(abilities_of(tool))),
      end_(std::visit(
          [&](const auto& end) {
            return make_tool_end(end, EndPlace{index, tool, dt});
          },
          tool.end)),
      safety_(tool.max_force, tool.max_force_rate, dt),
      force_scale_(tool.force_scale),
      motion_limits_(tool.motion),
      fade_step_(dt / kFadeSeconds),
      return_step_(dt / kReturnSeconds),
      slide_step_(dt / kSlideOut) {}

bool ToolRig::start(const ToolDofs& dofs) {
  if (!sense(dofs)) return false;
  before_ = now_;
  end_->start(dofs.grip);
  handle_ = end_->handle();
  resumed_ = false;
  return true;
}

bool ToolRig::sense(const ToolDofs& dofs) {
  before_ = now_;
  dofs_ = dofs;
  const Eigen::Isometry3d pose = tip_pose(trocar_, dofs);
  const bool finite = pose.matrix().allFinite();
  if (finite) now_ = pose;
  return finite;
}

bool ToolRig::can_hold(int part, const Eigen::Vector3d& at) const {
  const ToolPart& p = end_->parts()[part];
  const Segment axis{Eigen::Vector3d::Zero(), p.length * Eigen::Vector3d::UnitZ()};
  return (at - nearest_point(axis, at)).norm() <= std::max(kSkin * p.radius, 2 * jaw_length_);
}

void ToolRig::work(BodyParts bodies) {
  const bool held = end_->holding();
  end_->work(dofs_.grip, before_, bodies);
  lets_go_ = held && !end_->holding();
}

void ToolRig::count_motion() {
  const double handle = end_->handle();
  port_.motion = motion_between(before_, now_, handle - handle_);
  handle_ = handle;
}

void ToolRig::ask(const ToolLoad& load) {
  port_.asked = {force_scale_ * load.force, force_scale_ * load.torque, force_scale_ * end_->torque()};
  slide_out(port_.asked);
  output_ = {.press = load.press, .flags = load.flags};
  output_.flags |= safety_.limit(port_.asked);
}

// Moving tissue hears of it some steps later: whatever is gone by then goes evenly.
void ToolRig::slide_out(PortForce& wanted) {
  if (lets_go_) sliding_ = 1;
  if (sliding_ > 0) {
    const double share = std::min(slide_step_ / sliding_, 1.0);  // of the way that is left
    wanted.force = wanted_.force + share * (wanted.force - wanted_.force);
    wanted.torque = wanted_.torque + share * (wanted.torque - wanted_.torque);
    wanted.grip = wanted_.grip + share * (wanted.grip - wanted_.grip);
    sliding_ = std::max(sliding_ - slide_step_, 0.0);
  }
  wanted_ = wanted;
}

void ToolRig::give(bool healthy) {
  PortForce& given = port_.held = port_.asked;
  if (port_.limited) output_.flags |= passivity_limited;
  fade(given);
  output_.flags |= safety_.apply(given, {port_.motion, port_.spare, healthy});
  output_.force = given.force;
  output_.torque = given.torque;
  output_.along = generalised_force(trocar_, dofs_, given.force, given.torque);
  output_.grip = given.grip;
  output_.trocar = trocar_reaction(trocar_, dofs_, shaft_length_, given.force, given.torque).trocar;
}

void ToolRig::fade(PortForce& given) {
  held_ = std::clamp(held_ + (dofs_.silent ? -fade_step_ : return_step_), 0.0, 1.0);
  if (held_ == 1) return;
  output_.flags |= silent_device;
  given.force *= held_;
  given.torque *= held_;
  given.grip *= held_;
}

void ToolRig::state(State& s) {
  s.value(now_.matrix());
  if (s.restoring()) before_ = now_;
  SafetyChain::State safety = safety_.state();
  s.value(safety);
  if (s.restoring()) safety_.set_state(safety);
  end_->state(s);
  s.value(handle_);
  s.value(held_);
  s.value(wanted_.force);
  s.value(wanted_.torque);
  s.value(wanted_.grip);
  s.value(sliding_);
}

}  // namespace palpate
