#include "common/sim/forceps_hand.hpp"

#include <algorithm>

#include "common/tool/instrument.hpp"
#include "common/tool/jaws.hpp"

namespace palpate {

ForcepsHand::ForcepsHand(int tool, const Tool& settings, double dt)
    : tool_(tool),
      shape_(*forceps_shape(settings)),
      law_{.most_open = settings.forceps()->jaws.most_open,
           .stiffness = settings.forceps()->jaws.grip_stiffness,
           .friction = settings.forceps()->jaws.friction},
      dt_(dt),
      compliance_(settings.compliance) {
  obstacles_.reserve(most_obstacles);
}

GripEvent ForcepsHand::work(double commanded, const Eigen::Isometry3d& pose, const Graspable& within) {
  Grip& grip = state_.grip;
  const bool held = grip.holding;
  // What is held keeps the jaws where they met it: the tissue between them moves a little with every step.
  const Found found = held ? Found{grip.touch, grip.distance} : between_jaws_of(pose, within);
  GripEvent event = work_grip(grip, law_, commanded, found.opening, found.distance, held ? load(within) : 0.0, dt_);
  state_.tightest = held ? std::min(state_.tightest, grip.commanded) : grip.commanded;
  if (event == GripEvent::dropped && grip.commanded > state_.tightest + jaw_slack) event = GripEvent::released;
  if (found.opening == 0 || grip.commanded > found.opening + jaw_slack) state_.slipped = false;
  if (event == GripEvent::taken && state_.slipped) {
    grip.holding = false;
    event = GripEvent::none;
  }
  if (event == GripEvent::taken) take(pose, within);
  if (event == GripEvent::released || event == GripEvent::dropped) let_go(within);
  if (event == GripEvent::dropped) state_.slipped = true;
  return event;
}

ForcepsHand::Found ForcepsHand::between_jaws_of(const Eigen::Isometry3d& pose, const Graspable& within) {
  Found most;
  const auto enter = [&](const Found& found) {
    if (found.opening > most.opening) most = found;
  };
  for (const auto& catheter : within.catheters)
    if (catheter) enter(find_catheter(*catheter, pose));
  for (const auto& body : within.bodies)
    if (body) enter(find_tissue(*body, pose));
  return most;
}

ForcepsHand::Found ForcepsHand::find_catheter(const CatheterBody& catheter, const Eigen::Isometry3d& pose) const {
  Found most;
  const double reach = shape_.jaw_length + catheter.radius() + catheter.spacing();
  const auto x = catheter.positions();
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    if ((x[i] - pose.translation()).squaredNorm() > reach * reach) continue;
    const Segment piece{pose.inverse() * x[i], pose.inverse() * x[i + 1]};
    const double opening = opening_at_contact(shape_, piece, catheter.radius());
    if (opening > most.opening)
      most = {opening, nearest_point(piece, Eigen::Vector3d(0, 0, shape_.jaw_length / 2)).norm()};
  }
  return most;
}

// Where the plane in which the jaws turn cuts the surface, edge by edge: nodes alone would miss what passes between
// them.
ForcepsHand::Found ForcepsHand::find_tissue(const TouchBody& body, const Eigen::Isometry3d& pose) {
  obstacles_.clear();
  double distance = 0;
  const double radius = body.wall_radius();
  const Eigen::Isometry3d to_tip = pose.inverse();
  const Eigen::Vector3d middle = pose * Eigen::Vector3d(0, 0, shape_.jaw_length / 2);
  for (int t : body.surface().find(middle, middle, shape_.jaw_length)) {
    const Triangle corners = body.surface().corners(t);
    const std::array<Eigen::Vector3d, 3> p{to_tip * corners[0], to_tip * corners[1], to_tip * corners[2]};
    for (int v = 0; v < 3; ++v) {
      const Eigen::Vector3d &a = p[v], &b = p[(v + 1) % 3];
      if ((a.x() < 0) == (b.x() < 0) || obstacles_.size() == most_obstacles) continue;
      const Eigen::Vector3d cut = a + a.x() / (a.x() - b.x()) * (b - a);
      if (cut.z() <= 0 || cut.z() > shape_.jaw_length) continue;
      obstacles_.push_back({cut, radius});
      distance += cut.z();
    }
  }
  if (obstacles_.empty()) return {};
  return {opening_at_contact(shape_, obstacles_, state_.grip.opening),
          distance / static_cast<double>(obstacles_.size())};
}

double ForcepsHand::load(const Graspable& within) const {
  double sum = 0;
  for (const auto& catheter : within.catheters)
    if (catheter && catheter->holds(tool_)) sum += catheter->load(tool_);
  for (const auto& body : within.bodies)
    if (body) sum += body->grasp_load(tool_);
  return sum;
}

void ForcepsHand::take(const Eigen::Isometry3d& pose, const Graspable& within) {
  for (const auto& catheter : within.catheters)
    if (catheter && find_catheter(*catheter, pose).opening > 0) {
      const ChainPoint point = catheter->nearest(pose * Eigen::Vector3d(0, 0, shape_.jaw_length / 2));
      catheter->grasp(tool_, pose, point, 2 * shape_.jaw_radius, compliance_);
    }
  for (const auto& body : within.bodies)
    if (body) body->grasp(tool_, pose, shape_, state_.grip.opening);
}

void ForcepsHand::let_go(const Graspable& within) const {
  for (const auto& catheter : within.catheters)
    if (catheter) catheter->let_go(tool_);
  for (const auto& body : within.bodies)
    if (body) body->let_go(tool_);
}

}  // namespace palpate
