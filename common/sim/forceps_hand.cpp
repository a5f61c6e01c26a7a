#include "common/sim/forceps_hand.hpp"

#include <algorithm>

#include "common/tool/instrument.hpp"
#include "common/tool/jaws.hpp"

namespace palpate {
namespace {

GripLaw law_of(const TurningJaws& jaws) {
  return {.max_open = jaws.max_open, .stiffness = jaws.grip_stiffness, .friction = jaws.friction};
}

}  // namespace

ForcepsHand::ForcepsHand(int tool, const Tool& settings, double dt)
    : tool_(tool),
      shape_(*forceps_shape(settings)),
      law_(law_of(*abilities_of(settings).turning)),
      dt_(dt),
      compliance_(settings.compliance) {}

GripEvent ForcepsHand::work(double commanded, const Eigen::Isometry3d& pose, BodyParts bodies) {
  for (const auto& body : bodies) body->before_grip(tool_);
  const GripEvent event = grip(commanded, pose, bodies);
  for (const auto& body : bodies) body->after_grip(tool_, event);
  return event;
}

GripEvent ForcepsHand::grip(double commanded, const Eigen::Isometry3d& pose, BodyParts bodies) {
  Grip& grip = state_.grip;
  const bool held = grip.holding;
  // What is held keeps the jaws where they met it: the tissue between them moves a little with every step.
  const BetweenJaws found = held ? BetweenJaws{grip.touch, grip.distance} : between(pose, bodies);
  double load = 0;
  if (held)
    for (const auto& body : bodies) load += body->grasp_load(tool_);
  GripEvent event = work_grip(grip, law_, commanded, found.opening, found.distance, load, dt_);
  state_.tightest = held ? std::min(state_.tightest, grip.commanded) : grip.commanded;
  if (event == GripEvent::dropped && grip.commanded > state_.tightest + kJawSlack) event = GripEvent::released;
  if (found.opening == 0 || grip.commanded > found.opening + kJawSlack) state_.slipped = false;
  if (event == GripEvent::taken && state_.slipped) {
    grip.holding = false;
    event = GripEvent::none;
  }
  if (event == GripEvent::taken)
    for (const auto& body : bodies) body->grasp(jaws(pose));
  if (event == GripEvent::released || event == GripEvent::dropped)
    for (const auto& body : bodies) body->let_go(tool_);
  if (event == GripEvent::dropped) state_.slipped = true;
  return event;
}

BetweenJaws ForcepsHand::between(const Eigen::Isometry3d& pose, BodyParts bodies) const {
  BetweenJaws most;
  for (const auto& body : bodies) {
    const BetweenJaws found = body->between(jaws(pose));
    if (found.opening > most.opening) most = found;
  }
  return most;
}

}  // namespace palpate
