#include "common/contact/contact_law.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kGapTolerance = 1e-9;    // [m] deeper than this an open contact closes
constexpr double kForceTolerance = 1e-9;  // share of the largest contact force that counts as tension
constexpr int kSweepBudget = 800;         // points relaxed in a step, in 5 to 40 sweeps
constexpr int kPassBudget = 400;          // points times passes of the active set under friction, 4 to 16 passes
constexpr double kSweepTolerance = 1e-4;  // change of a force in a sweep, as a share of the largest, that ends it
constexpr double kFrictionLag = 1e-3;     // share of the normal force by which lagged friction may be stale

using ConstVec = Eigen::Map<const Eigen::Vector3d>;

}  // namespace

ContactLaw::ContactLaw(const ContactBody& body, Rule rule, double friction, int capacity, std::optional<ContactBody> by)
    : body_(body),
      by_(by),
      rule_(rule),
      friction_(friction),
      held_(body.response, rule == Rule::alpha ? 3 * capacity : capacity, by ? &by->response : nullptr) {
  contacts_.reserve(capacity);
  expansions_.reserve(capacity);
  const int points = held_.capacity();
  restuck_.assign(capacity, false);
  hold_.assign(points, Hold::none);
  normal_.assign(points, Eigen::Vector3d::Zero());
  displacement_target_.assign(points, Eigen::Vector3d::Zero());
  forces_.assign(3 * points, 0.0);
  displacements_.assign(3 * points, 0.0);
}

bool ContactLaw::grasps(int tool) const {
  return std::ranges::any_of(contacts_, [&](const TouchContact& c) { return c.grasped && c.is_by(tool); });
}

bool ContactLaw::full() const {
  return contacts_.size() == contacts_.capacity();
}

int ContactLaw::first_point(int contact) const {
  int first = 0;
  for (int c = 0; c < contact; ++c) first += expansions_[c].points;
  return first;
}

// [m] where the anchor is without contact forces, as what presses sees it.
Eigen::Vector3d ContactLaw::unloaded(const TouchContact& contact) const {
  const Eigen::Vector3d own = anchor_position(contact.anchor, body_.unloaded);
  const Anchor* by = std::get_if<Anchor>(&contact.by);
  return by ? Eigen::Vector3d(own - anchor_position(*by, by_->unloaded)) : own;
}

// A vertex that an older contact prescribes already is left to it: the newer contact falls back to its anchor.
bool ContactLaw::shares_vertex(const TouchContact& contact) const {
  for (int p = 0; p < held_.size(); ++p)
    for (int node : contact.anchor.nodes)
      if (held_.anchor(p).weights[0] == 1 && held_.anchor(p).nodes[0] == node) return true;
  return false;
}

ContactLaw::Expansion ContactLaw::expand(const TouchContact& contact, int points, std::array<Anchor, 3>& anchors) {
  anchors[0] = contact.anchor;
  if (points == 1) return {};
  const Eigen::Vector3d alpha = alpha_weights(contact.anchor.weights);
  Expansion e{.points = 3};
  for (int v = 0; v < 3; ++v) {
    const int node = contact.anchor.nodes[v];
    anchors[v] = Anchor{{node, node, node}, Eigen::Vector3d::UnitX()};
    e.gain[v] = alpha[v];
    e.share[v] = contact.anchor.weights[v];
  }
  return e;
}

void ContactLaw::add_points(const TouchContact& contact, int points) {
  std::array<Anchor, 3> anchors;
  const Expansion e = expand(contact, points, anchors);
  const int first = held_.size();
  for (int k = 0; k < e.points; ++k) held_.add(anchors[k], contact.by);
  std::fill_n(forces_.begin() + 3 * first, 3 * e.points, 0.0);
  contacts_.push_back(contact);
  expansions_.push_back(e);
}

void ContactLaw::add(const TouchContact& contact) {
  const bool by_tool = std::holds_alternative<ToolPoint>(contact.by);
  const bool spread = rule_ == Rule::alpha && by_tool && contact.face && !shares_vertex(contact);
  add_points(contact, spread ? 3 : 1);
}

void ContactLaw::add(const TouchContact& contact, std::span<const double> point_forces) {
  add_points(contact, point_forces.size() == 9 ? 3 : 1);
  const int last = static_cast<int>(contacts_.size()) - 1;
  std::copy(point_forces.begin(), point_forces.end(), forces_.begin() + 3 * first_point(last));
}

std::span<const double> ContactLaw::point_forces(int contact) const {
  return std::span(forces_).subspan(3 * first_point(contact), 3 * expansions_[contact].points);
}

void ContactLaw::remove(int contact) {
  const int first = first_point(contact), points = expansions_[contact].points, n = held_.size();
  for (int k = points - 1; k >= 0; --k) held_.remove(first + k);
  std::copy(forces_.begin() + 3 * (first + points), forces_.begin() + 3 * n, forces_.begin() + 3 * first);
  contacts_.erase(contacts_.begin() + contact);
  expansions_.erase(expansions_.begin() + contact);
}

void ContactLaw::clear() {
  held_.clear();
  contacts_.clear();
  expansions_.clear();
}

void ContactLaw::move_anchor(int contact, const Anchor& anchor) {
  TouchContact moved = contacts_[contact];
  moved.anchor = anchor;
  remove(contact);
  add(moved);
}

Eigen::Vector3d ContactLaw::displacement(int contact) const {
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  const int first = first_point(contact);
  for (int k = 0; k < expansions_[contact].points; ++k)
    u += expansions_[contact].share[k] * ConstVec(displacements_.data() + 3 * (first + k));
  return u;
}

// Where the anchor is now: what holds it has given way by a part of the displacement.
void ContactLaw::place(int c) {
  TouchContact& contact = contacts_[c];
  contact.position = unloaded(contact) + displacement(c);
  if (contact.softness() == 0) return;
  const int first = first_point(c);
  for (int k = 0; k < expansions_[c].points; ++k)
    contact.position -= contact.softness() * expansions_[c].share[k] * ConstVec(forces_.data() + 3 * (first + k));
}

// One linear solve for the present states. Friction of sliding contacts is taken from the last known normal force.
int ContactLaw::solve_held() {
  int p = 0;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const TouchContact& contact = contacts_[c];
    const Expansion& e = expansions_[c];
    const Eigen::Vector3d rest = unloaded(contact);
    const bool sliding = contact.touch == Touch::sliding;
    const Eigen::Vector3d wanted = sliding
                                       ? Eigen::Vector3d(contact.normal * (contact.plane - contact.normal.dot(rest)))
                                       : Eigen::Vector3d(contact.target - rest);
    const Eigen::Vector3d friction =
        sliding ? Eigen::Vector3d(friction_ * std::max(0.0, contact.force.dot(contact.normal)) * contact.slip)
                : Eigen::Vector3d::Zero();
    double gains = 0;
    for (int k = 0; k < e.points; ++k) gains += e.gain[k] * e.gain[k];
    for (int k = 0; k < e.points; ++k, ++p) {
      hold_[p] = contact.touch == Touch::open ? Hold::none : sliding ? Hold::normal : Hold::all;
      normal_[p] = contact.normal;
      displacement_target_[p] = e.gain[k] * wanted;
      Eigen::Map<Eigen::Vector3d>(forces_.data() + 3 * p) = e.gain[k] / gains * friction;
    }
  }
  const int raised = held_.solve(std::span(hold_).first(p), std::span(normal_).first(p),
                                 std::span(displacement_target_).first(p), forces_.data());
  held_.displacements(forces_.data(), displacements_.data());

  worst_lag_ = 0;
  p = 0;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    TouchContact& contact = contacts_[c];
    const double before = contact.force.dot(contact.normal);
    contact.force.setZero();
    for (int k = 0; k < expansions_[c].points; ++k, ++p)
      contact.force += expansions_[c].gain[k] * ConstVec(forces_.data() + 3 * p);
    if (contact.touch != Touch::sliding || contact.slip.isZero(0)) continue;
    const double now = contact.force.dot(contact.normal);
    worst_lag_ = std::max(worst_lag_, std::abs(now - before) - kFrictionLag * std::abs(now));
  }
  return raised;
}

bool ContactLaw::change_state(int c, double min_force) {
  TouchContact& contact = contacts_[c];
  place(c);
  if (contact.grasped) return false;
  if (contact.touch == Touch::open) {
    if (contact.normal.dot(contact.position) - contact.plane >= -kGapTolerance) return false;
    contact.touch = friction_ > 0 ? Touch::sticking : Touch::sliding;
    contact.slip.setZero();
    return true;
  }
  const double pressing = contact.force.dot(contact.normal);
  if (pressing < -min_force) {
    contact.touch = Touch::open;
    contact.force.setZero();
    return true;
  }
  if (friction_ == 0) return false;
  if (contact.touch == Touch::sticking) {
    const Eigen::Vector3d tangential = contact.force - pressing * contact.normal;
    const double size = tangential.norm();
    if (size <= friction_ * pressing + min_force) return false;
    contact.touch = Touch::sliding;
    contact.slip = tangential / size;
    return true;
  }
  // Sliding: friction acts along the slip, that is from the tissue's point towards the tool's. If the slip has turned
  // round the contact sticks again, once in a step.
  Eigen::Vector3d slip = contact.target - contact.held_at();
  slip -= slip.dot(contact.normal) * contact.normal;
  if (restuck_[c] || slip.dot(contact.slip) >= -kGapTolerance) return false;
  restuck_[c] = true;
  contact.touch = Touch::sticking;
  return true;
}

bool ContactLaw::change_states(bool one_only, double min_force) {
  bool changed = false;
  for (int c = 0; c < static_cast<int>(contacts_.size()); ++c) {
    changed |= change_state(c, min_force);
    if (changed && one_only) return true;
  }
  return changed;
}

// Block Gauss-Seidel over the contacts' points with projection onto the friction cone, from the forces at hand: for
// what the active set leaves open, such as many rubbing contacts that wedge one another. It ends within its bound, and
// every force it leaves lies in its cone.
void ContactLaw::relax() {
  held_.displacements(forces_.data(), displacements_.data());
  const int max_sweeps = std::clamp(kSweepBudget / held_.size(), 5, 40);
  double change = 1, largest = 0;
  for (int sweep = 0; sweep < max_sweeps && change > kSweepTolerance * largest; ++sweep) {
    change = largest = 0;
    int p = 0;
    for (std::size_t c = 0; c < contacts_.size(); ++c)
      for (int k = 0; k < expansions_[c].points; ++k, ++p) {
        change = std::max(change, relax_point(contacts_[c], expansions_[c].gain[k], p));
        largest = std::max(largest, ConstVec(forces_.data() + 3 * p).norm());
      }
  }
  int p = 0;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    TouchContact& contact = contacts_[c];
    contact.force.setZero();
    for (int k = 0; k < expansions_[c].points; ++k, ++p)
      contact.force += expansions_[c].gain[k] * ConstVec(forces_.data() + 3 * p);
    place(static_cast<int>(c));
    if (contact.grasped) continue;
    const double pressing = contact.force.dot(contact.normal);
    const Eigen::Vector3d tangential = contact.force - pressing * contact.normal;
    const bool slides = tangential.norm() >= friction_ * pressing * (1 - 1e-6);
    contact.touch = pressing <= 0 ? Touch::open : slides ? Touch::sliding : Touch::sticking;
    contact.slip = slides && !tangential.isZero(0) ? tangential.normalized() : Eigen::Vector3d::Zero();
  }
}

// First the normal force against the gap, then friction against the slip. Returns the size of the change [N].
double ContactLaw::relax_point(const TouchContact& contact, double gain, int p) {
  const Eigen::Vector3d& n = contact.normal;
  const Eigen::Matrix3d own = held_.block(p, p);
  const Eigen::Vector3d rest = unloaded(contact);
  Eigen::Map<Eigen::Vector3d> force(forces_.data() + 3 * p);
  const Eigen::Vector3d before = force;
  const double softest = held_.floor_of(own.trace() / 3);

  const Eigen::Vector3d u = ConstVec(displacements_.data() + 3 * p);
  if (contact.grasped) {
    const Eigen::Vector3d change = (gain * (contact.target - rest) - u) / std::max(own.trace(), softest);
    force += change;
    held_.add_response(p, change, displacements_.data());
    return change.norm();
  }
  const double gap_left = gain * (contact.plane - n.dot(rest)) - n.dot(u);
  const double pressing = std::max(0.0, force.dot(n) + gap_left / std::max(n.dot(own * n), softest));
  const Eigen::Vector3d normal_change = (pressing - force.dot(n)) * n;
  force += normal_change;

  Eigen::Vector3d slip = gain * (contact.target - rest) - u - own * normal_change;
  slip -= slip.dot(n) * n;
  Eigen::Vector3d tangential = force - pressing * n + slip / std::max(own.trace(), softest);
  const double allowed = friction_ * pressing, size = tangential.norm();
  if (size > allowed) tangential *= allowed / size;
  force = pressing * n + tangential;
  const Eigen::Vector3d change = force - before;
  held_.add_response(p, change, displacements_.data());
  return change.norm();
}

LawOutcome ContactLaw::solve() {
  LawOutcome outcome;
  if (contacts_.empty()) return outcome;
  std::fill(restuck_.begin(), restuck_.end(), false);
  bool changed = true;
  const int pass_limit = friction_ > 0 ? std::clamp(kPassBudget / held_.size(), 4, 16) : kMaxPasses;
  while (changed && outcome.passes < pass_limit) {
    outcome.raised = solve_held();
    ++outcome.passes;
    double largest = 0;
    for (const TouchContact& c : contacts_) largest = std::max(largest, c.force.norm());
    if (!std::isfinite(largest)) {
      outcome.finite = false;
      std::fill(forces_.begin(), forces_.end(), 0.0);
      clear();
      return outcome;
    }
    // All at once while that makes quick progress, then one at a time in the order of the list, which cannot cycle
    // for a fixed set of normals (least-index pivoting of a positive definite complementarity problem).
    changed = change_states(outcome.passes > pass_limit / 2, kForceTolerance * largest);
    changed |= worst_lag_ > 0;
  }
  outcome.converged = !changed;
  if (changed) relax();
  return outcome;
}

}  // namespace palpate
