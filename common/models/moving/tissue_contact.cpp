#include "common/models/moving/tissue_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/segment.hpp"
#include "common/tool/jaws.hpp"

namespace palpate {
namespace {

constexpr int kSweeps = 8;            // Gauss-Seidel over the contacts: more than one where they share nodes
constexpr double kMarginShare = 0.1;  // of a part's radius: what is this near is watched before it is touched

// From a part's axis to a surface point, on the side from which the surface may be touched.
Eigen::Vector3d direction_to(const Eigen::Vector3d& point, const Eigen::Vector3d& centre,
                             const Eigen::Vector3d& outward) {
  const Eigen::Vector3d d = point - centre;
  return d.dot(outward) < 0 ? Eigen::Vector3d(d.normalized()) : Eigen::Vector3d(-outward);
}

}  // namespace

TissueContacts::TissueContacts(const ElasticMesh& mesh, const CutMesh& topology, const ShownSurface& shown,
                               const CutSurface& surface, DynamicModel& model, double friction)
    : mesh_(mesh), topology_(topology), shown_(shown), surface_(surface), model_(model), friction_(friction) {
  contacts_.reserve(kMost);
  before_.reserve(kMost);
  other_load_.reserve(3 * kMost);
}

Eigen::Vector3d TissueContacts::position(const Anchor& a) const {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  for (int v = 0; v < 3; ++v)
    if (a.weights[v] != 0) p += a.weights[v] * (mesh_.rest[a.nodes[v]] + model_.displacement(a.nodes[v]));
  return p;
}

// Zero along fixed axes and for nodes that have left.
Eigen::Vector3d TissueContacts::inverse_mass(int node) const {
  const double m = model_.mass(node);
  if (!(m > 0)) return Eigen::Vector3d::Zero();
  const auto& fixed = mesh_.fixed[node];
  return {fixed[0] ? 0 : 1 / m, fixed[1] ? 0 : 1 / m, fixed[2] ? 0 : 1 / m};
}

bool TissueContacts::anchored(const TissueContact& c) const {
  for (int v = 0; v < 3; ++v)
    if (c.anchor.weights[v] != 0 && !topology_.has_node(c.anchor.nodes[v])) return false;
  return true;
}

void TissueContacts::forget_removed() {
  std::erase_if(contacts_, [&](const TissueContact& c) { return !anchored(c); });
}

void TissueContacts::drop_tool(int tool) {
  std::erase_if(contacts_, [&](const TissueContact& c) { return c.tool == tool; });
}

void TissueContacts::let_go(int tool) {
  std::erase_if(contacts_,
                [&](const TissueContact& c) { return c.tool == tool && c.sample == TissueContact::kInJaws; });
}

bool TissueContacts::grasping(int tool) const {
  return std::ranges::any_of(
      contacts_, [&](const TissueContact& c) { return c.tool == tool && c.sample == TissueContact::kInJaws; });
}

void TissueContacts::set_list(std::span<const TissueContact> contacts) {
  contacts_.assign(contacts.begin(), contacts.end());
}

void TissueContacts::find(std::span<const MovingTool> tools) {
  before_.clear();
  before_.swap(contacts_);
  for (const TissueContact& c : before_)
    if (c.sample == TissueContact::kInJaws) contacts_.push_back(c);
  for (int t = 0; t < static_cast<int>(tools.size()); ++t)
    for (int p = 0; p < tools[t].size(); ++p) find_part(tools, t, p);
}

void TissueContacts::find_part(std::span<const MovingTool> tools, int tool, int sample) {
  const MovingTool& moving = tools[tool];
  const Segment before = moving.axis_before(sample), now = moving.axis(sample);
  const double reach = (1 + kMarginShare) * moving.radius(sample);
  if (add_crossing(moving, tool, sample)) return;
  // The boxes of the axis and of its way here: all that a sphere sweeps, and of a segment what its ends sweep.
  const Eigen::Vector3d low = now.start.cwiseMin(now.end).cwiseMin(before.start).cwiseMin(before.end);
  const Eigen::Vector3d high = now.start.cwiseMax(now.end).cwiseMax(before.start).cwiseMax(before.end);
  const std::span<const int> near = surface_.find(low, high, reach);
  if (near.empty()) return;
  const std::size_t first = contacts_.size();
  add_nodes(moving, tool, sample, near);
  if (contacts_.size() == first) add_face(moving, tool, sample, near);
}

// The part's axis has passed through the surface within this tick: the contact is made where a point of it, one in each
// radius, passed first.
bool TissueContacts::add_crossing(const MovingTool& moving, int tool, int sample) {
  const Segment from = moving.axis_before(sample), to = moving.axis(sample);
  const int last = static_cast<int>(std::ceil(moving.parts[sample].length / moving.radius(sample)));
  double earliest = std::numeric_limits<double>::infinity();
  TissueContact c{.tool = tool, .sample = sample, .face = 1};
  for (int i = 0; i <= last; ++i) {
    const double share = last > 0 ? static_cast<double>(i) / last : 0.0;
    const Eigen::Vector3d before = from.at(share), now = to.at(share);
    for (int facet : surface_.find(before, now, 0)) {
      const auto hit = sweep_point(before, now, surface_.previous_corners(facet), surface_.corners(facet));
      if (!hit || !hit->from_outside || shown_.is_joint(facet) || hit->time >= earliest) continue;
      earliest = hit->time;
      c.anchor = {topology_.facet(facet), hit->weights};
      c.normal = -surface_.normal(facet);
    }
  }
  if (!std::isfinite(earliest)) return false;
  add(c, moving);
  return true;
}

// Where facets are smaller than the part's radius, their nodes carry the contact.
void TissueContacts::add_nodes(const MovingTool& moving, int tool, int sample, std::span<const int> near) {
  const Segment axis = moving.axis(sample);
  const double radius = moving.radius(sample), reach = (1 + kMarginShare) * radius;
  for (int facet : near) {
    const std::array<int, 3> nodes = topology_.facet(facet);
    double edges = 0;
    for (int v = 0; v < 3; ++v) edges += (mesh_.rest[nodes[v]] - mesh_.rest[nodes[(v + 1) % 3]]).norm();
    if (edges / 3 > radius || shown_.is_joint(facet)) continue;
    for (int node : nodes) {
      const Eigen::Vector3d &x = surface_.positions()[node], centre = nearest_point(axis, x);
      if ((x - centre).squaredNorm() > reach * reach) continue;
      const bool taken = std::ranges::any_of(contacts_, [&](const TissueContact& c) {
        return c.tool == tool && !c.face && c.anchor.nodes[0] == node &&
               (c.sample == sample || c.sample == TissueContact::kInJaws);
      });
      if (taken) continue;
      TissueContact c{.tool = tool, .sample = sample};
      c.anchor = {{node, node, node}, Eigen::Vector3d::UnitX()};
      c.normal = direction_to(x, centre, surface_.vertex_normal(node));
      add(c, moving);
    }
  }
}

// Where they are larger, the part touches between nodes, at the surface point nearest to its axis.
void TissueContacts::add_face(const MovingTool& moving, int tool, int sample, std::span<const int> near) {
  const Segment axis = moving.axis(sample);
  const double reach = (1 + kMarginShare) * moving.radius(sample);
  double least = reach * reach;
  TissueContact c{.tool = tool, .sample = sample, .face = 1};
  int nearest = -1;
  for (int facet : near) {
    const Triangle corners = surface_.corners(facet);
    const ClosestOfTriangle p = closest_points(axis, corners);
    const Eigen::Vector3d centre = axis.at(p.share);
    const Eigen::Vector3d at = p.weights[0] * corners[0] + p.weights[1] * corners[1] + p.weights[2] * corners[2];
    if (p.squared_distance >= least || shown_.is_joint(facet) || (centre - at).dot(surface_.normal(facet)) <= 0)
      continue;
    least = p.squared_distance;
    nearest = facet;
    c.anchor = {topology_.facet(facet), p.weights};
    c.normal = direction_to(at, centre, surface_.normal(facet));
  }
  // In its own dent the part's axis may have come behind every facet: what it touched before goes on.
  const auto held = std::ranges::find_if(
      before_, [&](const TissueContact& b) { return b.tool == tool && b.sample == sample && b.face; });
  const bool goes_on = held != before_.end() && anchored(*held) && held->force.dot(held->normal) > 0;
  if (goes_on && (nearest < 0 || held->sticking)) {
    const Eigen::Vector3d at = anchor_position(held->anchor, surface_.positions()), centre = nearest_point(axis, at);
    c.anchor = held->anchor;
    c.normal = (at - centre).dot(held->normal) > 0 ? Eigen::Vector3d((at - centre).normalized()) : held->normal;
    nearest = 0;
  }
  if (nearest >= 0) add(c, moving);
}

// A contact of the same part at the same node, or within a facet, keeps where it sticks.
void TissueContacts::add(const TissueContact& contact, const MovingTool& tool) {
  if (contacts_.size() == kMost) return;
  TissueContact& c = contacts_.emplace_back(contact);
  const auto old = std::ranges::find_if(before_, [&](const TissueContact& b) {
    return b.tool == c.tool && b.sample == c.sample && b.face == c.face &&
           (c.face || b.anchor.nodes[0] == c.anchor.nodes[0]);
  });
  const bool goes_on = old != before_.end() && old->force.dot(old->normal) > 0;
  c.sticking = goes_on ? old->sticking : 1;
  if (goes_on) c.force = old->force;
  c.offset = goes_on && old->sticking ? old->offset : tool.to_part_before(c.sample, position(c.anchor));
}

bool TissueContacts::grasp(int tool, const Eigen::Isometry3d& pose, double length, double width) {
  const Eigen::Isometry3d to_tip = pose.inverse();
  const std::size_t first = contacts_.size();
  const auto take = [&](const Anchor& anchor, bool face) {
    if (contacts_.size() == kMost) return;
    TissueContact c{.tool = tool, .sample = TissueContact::kInJaws, .face = face};
    c.anchor = anchor;
    c.offset = to_tip * position(anchor);
    contacts_.push_back(c);
  };
  for (int n = 0; n < mesh_.nodes(); ++n)
    if (topology_.has_node(n) && between_jaws(to_tip * surface_.positions()[n], length, width))
      take({{n, n, n}, Eigen::Vector3d::UnitX()}, false);
  if (contacts_.size() > first) return true;
  // Coarser than the jaws: they hold the surface point nearest to their middle.
  const Eigen::Vector3d middle = pose * Eigen::Vector3d(0, 0, 0.5 * length);
  const double within = 0.25 * length * length;
  double least = within;
  Anchor nearest;
  for (int facet : surface_.find(middle, middle, length)) {
    const ClosestPoint p = closest_point(middle, surface_.corners(facet));
    if (p.squared_distance >= least || shown_.is_joint(facet)) continue;
    least = p.squared_distance;
    nearest = {topology_.facet(facet), p.weights};
  }
  if (least < within) take(nearest, true);
  return contacts_.size() > first;
}

Eigen::Vector3d TissueContacts::velocity(const Anchor& a) const {
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i)
    if (a.weights[i] != 0) v += a.weights[i] * model_.velocity(a.nodes[i]);
  return v;
}

// [1/kg] of an anchor, per axis: its displacement per push on it.
Eigen::Vector3d TissueContacts::mobility(const Anchor& a) const {
  Eigen::Vector3d m = Eigen::Vector3d::Zero();
  for (int v = 0; v < 3; ++v)
    if (a.weights[v] != 0) m += a.weights[v] * a.weights[v] * inverse_mass(a.nodes[v]);
  return m;
}

void TissueContacts::move(const Anchor& a, const Eigen::Vector3d& push, const Eigen::Vector3d& impulse) {
  for (int v = 0; v < 3; ++v) {
    if (a.weights[v] == 0) continue;
    const int node = a.nodes[v];
    const Eigen::Vector3d per_mass = a.weights[v] * inverse_mass(node);
    model_.set_motion(node, model_.displacement(node) + per_mass.cwiseProduct(push),
                      model_.velocity(node) + per_mass.cwiseProduct(impulse));
  }
}

void TissueContacts::load_tissue() {
  other_load_.clear();
  for (const TissueContact& c : contacts_)
    for (int v = 0; v < 3; ++v) {
      const int node = c.anchor.nodes[v];
      if (c.anchor.weights[v] == 0 || c.force.isZero(0)) continue;
      const bool seen = std::ranges::any_of(other_load_, [&](const auto& l) { return l.first == node; });
      if (!seen) other_load_.emplace_back(node, model_.load(node));
      model_.set_load(node, model_.load(node) + c.anchor.weights[v] * c.force);
    }
}

void TissueContacts::step(std::span<const MovingTool> tools, std::span<const Eigen::Isometry3d> begin,
                          std::span<const Eigen::Isometry3d> end, double dt) {
  load_tissue();
  model_.step(dt);
  for (const auto& [node, load] : other_load_) model_.set_load(node, load);
  for (TissueContact& c : contacts_) c.push = c.force * dt * dt;
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (TissueContact& c : contacts_) put_right(c, tools[c.tool], end[c.tool]);
  // What the jaws hold is put in its place last.
  for (TissueContact& c : contacts_)
    if (c.sample == TissueContact::kInJaws) put_right(c, tools[c.tool], end[c.tool]);
  for (TissueContact& c : contacts_) c.force = c.push / (dt * dt);
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (const TissueContact& c : contacts_) follow_tool(c, tools[c.tool], begin[c.tool], end[c.tool], dt);
}

// Where the tool in this pose holds a contact's point.
Eigen::Vector3d TissueContacts::held_at(const TissueContact& c, const MovingTool& tool, const Eigen::Isometry3d& pose) {
  return c.sample == TissueContact::kInJaws ? pose * c.offset : pose * (tool.parts[c.sample].pose * c.offset);
}

// The position of one contact's point: first the normal push against the gap, then friction against the slip.
void TissueContacts::put_right(TissueContact& c, const MovingTool& tool, const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d mobile = mobility(c.anchor);
  if (mobile.maxCoeff() <= 0) return;
  const Eigen::Vector3d x = position(c.anchor), miss = held_at(c, tool, pose) - x, pushed = c.push;
  if (c.sample == TissueContact::kInJaws) {
    for (int axis = 0; axis < 3; ++axis)
      if (mobile[axis] > 0) c.push[axis] += miss[axis] / mobile[axis];
  } else {
    const Eigen::Vector3d& n = c.normal;
    const double along = n.dot(mobile.cwiseProduct(n));
    if (along <= 0) return;
    const double gap = tool.radius(c.sample) - n.dot(x - nearest_point(tool.parts[c.sample].axis(pose), x));
    const double pressing = std::max(0.0, pushed.dot(n) + gap / along);
    const Eigen::Vector3d slip = miss - miss.dot(n) * n;
    const double across = std::max(0.5 * (mobile.sum() - along), 1e-3 * along);
    Eigen::Vector3d tangential = pushed - pushed.dot(n) * n + slip / across;
    const double allowed = friction_ * pressing, size = tangential.norm();
    c.sticking = size <= allowed;
    if (size > allowed) tangential *= allowed / size;
    c.push = pressing * n + tangential;
  }
  move(c.anchor, c.push - pushed, Eigen::Vector3d::Zero());
}

// Its velocity: that of the tool, along the normal alone where it slides.
void TissueContacts::follow_tool(const TissueContact& c, const MovingTool& tool, const Eigen::Isometry3d& begin,
                                 const Eigen::Isometry3d& end, double dt) {
  const bool kInJaws = c.sample == TissueContact::kInJaws;
  if (!kInJaws && c.force.dot(c.normal) <= 0) return;
  const Eigen::Vector3d mobile = mobility(c.anchor);
  const Eigen::Vector3d missing = (held_at(c, tool, end) - held_at(c, tool, begin)) / dt - velocity(c.anchor);
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();
  if (kInJaws || c.sticking) {
    for (int axis = 0; axis < 3; ++axis)
      if (mobile[axis] > 0) impulse[axis] = missing[axis] / mobile[axis];
  } else {
    const double along = c.normal.dot(mobile.cwiseProduct(c.normal));
    if (along > 0) impulse = missing.dot(c.normal) / along * c.normal;
  }
  move(c.anchor, Eigen::Vector3d::Zero(), impulse);
}

void TissueContacts::end_tick(std::span<const MovingTool> tools) {
  for (TissueContact& c : contacts_)
    if (c.sample != TissueContact::kInJaws && !c.sticking)
      c.offset = tools[c.tool].to_part(c.sample, position(c.anchor));
}

}  // namespace palpate
