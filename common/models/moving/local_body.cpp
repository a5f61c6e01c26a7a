#include "common/models/moving/local_body.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "common/contact/patch/patch_parts.hpp"
#include "common/geometry/arrays.hpp"
#include "common/geometry/segment.hpp"
#include "common/tool/safety.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Stiffness = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

constexpr double kRounding = 1e-9;
constexpr double kOwnReach = 1.25;  // of a part's radius: a contact this near to its axis is its own
constexpr double kDent = 3;         // radii of a part: a place this near to a contact lies in that one's dent
// [1] The middle of a square sinks by so much of its edge times pressure / (E / (1 - nu^2)): 4/pi asinh(1) (Love 1929),
// rounded; HalfSpace::pressed() has it for any place.
constexpr double kSquare = 1.12;

// [m] from a probe's tip to where its jaws end.
double jaws_reach(const Tool& tool) {
  const std::optional<ClosingJaws> closing = abilities_of(tool).closing;
  return closing ? std::hypot(closing->length, closing->width / 2) : 0;
}

bool beside(const MovingTool& tool, double reach, const Vector3d& at) {
  for (int p = 0; p < tool.size(); ++p)
    if ((at - nearest_point(tool.axis(p), at)).norm() <= 2 * tool.radius(p) + reach + LocalBody::kBeside) return true;
  return false;
}

// What a contact can bear: it never pulls, and friction is a share of its pressure.
Vector3d within_cone(const Vector3d& force, const Vector3d& normal, double friction) {
  const double pressure = force.dot(normal);
  if (pressure <= 0) return Vector3d::Zero();
  const Vector3d tangential = force - pressure * normal;
  const double size = tangential.norm(), most = friction * pressure;
  return size > most ? Vector3d(pressure * normal + most / size * tangential) : force;
}

Vector3d shortened(const Vector3d& v, double most) {
  const double size = v.norm();
  return size > most ? Vector3d(most / size * v) : v;
}

}  // namespace

LocalBody::LocalBody(const Tool& tool, const ContactSpec& contact, double dt)
    : trocar_(make_trocar(tool.pivot, tool.axis, tool.up)),
      jaws_(abilities_of(tool).holding),
      jaws_reach_(jaws_reach(tool)),
      patches_(contact.rule == ContactRule::patch),
      by_patch_(tool_parts(tool).size(), false),
      friction_(contact.friction),
      dt_(dt),
      rises_(static_cast<std::uint64_t>(std::lround(kRises / dt))),
      silent_(static_cast<std::uint64_t>(std::lround(kSilent / dt))) {
  for (const PatchPart& p : patch_parts({&tool, 1}, false)) by_patch_[p.part] = true;
  position_.fill(Vector3d::Zero());
  for (auto& box : box_) box.fill(Vector3d::Zero());
}

void LocalBody::consume(const LocalModel& model) {
  const bool after_silence = state_.silent > silent_;
  // The first one as well: the tool of a haptic node that has come back may be within the tissue, which learns of it
  // only now.
  if (after_silence || model.run != state_.model.run) {
    state_.from_force = state_.force;
    state_.from_torque = state_.torque;
    state_.from_weight = weight();
    state_.from_share = 1;
    state_.weight = 0;
  }
  count_lost(model);
  state_.silent = 0;
  state_.model = model;
  model_pose_ = tip_pose(trocar_, dofs_of(model.pose));
}

// Since the last model, evenly, as far as it is not forgotten yet. What one tick came late and the next made good is
// not lost.
void LocalBody::count_lost(const LocalModel& model) {
  const LocalModel& before = state_.model;
  const bool goes_on = before.seq != 0 && model.run == before.run;
  const double lost = goes_on ? 1e-9 * static_cast<double>(model.late_ns - before.late_ns) : 0;
  const double passed = static_cast<double>(std::max<std::uint64_t>(state_.silent, 1)) * dt_ / kLately;
  const double still_known = -std::expm1(-passed) / passed;
  state_.lost = goes_on ? std::clamp(state_.lost + still_known * lost, 0.0, kLately) : 0;
}

ToolLoad LocalBody::load(const MovingTool& tool, std::uint64_t step, double most) {
  const LocalModel& m = state_.model;
  ToolLoad load;
  stale_ = limited_ = late_ = false;
  state_.lost *= 1 - dt_ / kLately;
  const double age = step > m.tool_step ? static_cast<double>(step - m.tool_step) * dt_ : 0.0;
  const bool fresh = m.seq != 0 && age <= kOldest;
  const double change = dt_ / kFadeSeconds;
  state_.weight = std::clamp(state_.weight + (fresh ? change : -change), 0.0, 1.0);
  state_.from_share = std::max(state_.from_share - change, 0.0);
  if (m.seq == 0) return load;
  const int held = hold(tool, load);
  extrapolate(std::min(age, kExtrapolated));
  for (int p = 0; p < tool.size(); ++p) {
    Touched touched;
    const double radius = tool.radius(p);
    const Segment axis = tool.axis(p);
    if (holds(axis, radius, p, held) || !touch(tool, p, touched)) continue;
    if (patches_ && dented(touched.at, radius, held)) continue;
    add(touched.at, touched.force, tool, load);
  }
  keep_within(most, load);
  keep_steady(load);
  const bool felt = !load.force.isZero(0) || !load.torque.isZero(0);
  const bool coming = state_.from_share > 0;
  if (!felt && age <= kSilent) reach_.set_free(tool);
  if (fresh && !felt && !coming) state_.weight = 1;  // what begins from nothing needs no fading
  stale_ = weight() < 1 - kRounding && felt;
  late_ = state_.lost > kLate && felt;
  load.force *= state_.weight;
  load.torque *= state_.weight;
  come_from_before(load);
  return load;
}

// A model may tell anything.
void LocalBody::keep_within(double most, ToolLoad& load) {
  const double size = std::max(load.force.norm(), load.torque.norm() / SafetyChain::kMaxLever);
  if (!(size > most)) return;
  limited_ = true;
  const double share = std::max(most, 0.0) / size;
  load.force *= share;
  load.torque *= share;
  grasp_force_ *= share;
}

// Nobody knows how the tissue answers to a tool that goes on while no model comes. Where it goes through what stands
// there, its nearest surface is another one at once, time and again.
void LocalBody::keep_steady(ToolLoad& load) {
  Eigen::Map<Vector3d> force(state_.model_force.data()), torque(state_.model_torque.data());
  const double size = std::max(load.force.norm(), load.torque.norm() / SafetyChain::kMaxLever);
  if (++state_.silent <= rises_) {
    state_.ceiling = size;
  } else {
    const double share = size > state_.ceiling ? state_.ceiling / size : 1;
    const double most = state_.ceiling * dt_ / kTurns;
    load.force = force + shortened(share * load.force - force, most);
    load.torque = torque + shortened(share * load.torque - torque, most * SafetyChain::kMaxLever);
  }
  force = load.force;
  torque = load.torque;
}

void LocalBody::come_from_before(ToolLoad& load) {
  load.force += state_.from_share * vector(state_.from_force);
  load.torque += state_.from_share * vector(state_.from_torque);
  Eigen::Map<Vector3d>(state_.force.data()) = load.force;
  Eigen::Map<Vector3d>(state_.torque.data()) = load.torque;
}

void LocalBody::add(const Vector3d& at, const Vector3d& on_tissue, const MovingTool& tool, ToolLoad& load) const {
  load.force -= on_tissue;
  load.torque -= (at - tool.now.translation()).cross(on_tissue);
}

// Fills held_ with the places that the tool held in the model; returns their number.
int LocalBody::hold(const MovingTool& tool, ToolLoad& load) {
  const LocalModel& m = state_.model;
  const Eigen::Isometry3d motion = tool.now * model_pose_.inverse();
  int held = 0;
  grasp_force_.setZero();
  for (int i = 0; i < m.contacts; ++i) {
    const LocalModel::Contact& c = m.contact[i];
    const auto normal = vector(c.normal), before = vector(c.position), force = vector(c.force);
    if (!c.grasped && force.dot(normal) <= 0) continue;  // near, but it did not press
    const Vector3d at = motion * before;
    if (!beside(tool, c.grasped ? jaws_reach_ : 0, at)) {
      limited_ = true;
      continue;
    }
    Vector3d now = force + Stiffness(c.stiffness.data()) * (at - before);
    if (!c.grasped) now = within_cone(now, normal, friction_);
    held_[held++] = {at, c.grasped != 0};
    if (c.grasped) grasp_force_ += now;
    add(at, now, tool, load);
  }
  return held;
}

void LocalBody::extrapolate(double seconds) {
  const LocalModel& m = state_.model;
  for (int n = 0; n < m.nodes; ++n) position_[n] = vector(m.node[n].position) + seconds * vector(m.node[n].velocity);
  for (int t = 0; t < m.triangles; ++t) {
    const auto& [a, b, c] = m.triangle[t];
    box_[t] = {position_[a].cwiseMin(position_[b]).cwiseMin(position_[c]),
               position_[a].cwiseMax(position_[b]).cwiseMax(position_[c])};
  }
}

// How deep a part has come into the near surface, judged where its axis and the surface are nearest; on which side of
// the surface the axis lies, by the triangle that faces it most among those that share that point.
bool LocalBody::touch(const MovingTool& tool, int part, Touched& touched) const {
  const LocalModel& m = state_.model;
  const Segment axis = tool.axis(part);
  const double radius = tool.radius(part);
  double nearest = radius * radius, facing = 0;
  int found = -1;
  ClosestOfTriangle at;
  const Vector3d low = axis.start.cwiseMin(axis.end), high = axis.start.cwiseMax(axis.end);
  for (int t = 0; t < m.triangles; ++t) {
    if (((low - box_[t][1]).cwiseMax(box_[t][0] - high)).maxCoeff() > radius) continue;
    const auto& [a, b, c] = m.triangle[t];
    const Triangle corners{position_[a], position_[b], position_[c]};
    const ClosestOfTriangle point = closest_points(axis, corners);
    const double tie = 1e-9 * radius * radius;
    if (point.squared_distance > nearest + tie) continue;
    const Vector3d cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const double size = cross.norm();
    if (!(size > 0)) continue;
    const double above = (axis.at(point.share) - corners[0]).dot(cross) / size;
    const bool nearer = found < 0 || point.squared_distance < nearest - tie;
    if (!nearer && std::abs(above) <= std::abs(facing)) continue;
    nearest = std::min(nearest, point.squared_distance);
    facing = above;
    found = t;
    at = point;
  }
  if (found < 0) return false;
  const auto& nodes = m.triangle[found];
  touched.at.setZero();
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  for (int v = 0; v < 3; ++v) {
    touched.at += at.weights[v] * position_[nodes[v]];
    stiffness += at.weights[v] * Stiffness(m.node[nodes[v]].stiffness.data());
  }
  const double distance = std::sqrt(at.squared_distance), side = facing >= 0 ? 1 : -1;
  const Vector3d corner = position_[nodes[0]];
  const Vector3d outward = (position_[nodes[1]] - corner).cross(position_[nodes[2]] - corner).normalized();
  const Vector3d into =
      distance > 1e-6 * radius ? Vector3d(side * (touched.at - axis.at(at.share)) / distance) : Vector3d(-outward);
  const double along = into.dot(stiffness * into), depth = radius - side * distance;
  if (!(depth > 0 && along > 0)) return false;
  touched.force = depth / (1 / along + 1 / half_space(part, radius, depth)) * into;
  return true;
}

// [N/m] With which a half-space resists a part that is as deep: a sphere that presses by a patch by Hertz's law, any
// other one as a square of its width. Infinite where contacts are the mesh's alone.
double LocalBody::half_space(int part, double radius, double depth) const {
  if (!patches_) return std::numeric_limits<double>::infinity();
  return state_.model.modulus * (by_patch_[part] ? 4.0 / 3 * std::sqrt(radius * depth) : 2 * radius / kSquare);
}

// A part that held tissue in the model, or jaws with tissue between them, are felt by that alone, not twice.
bool LocalBody::holds(const Segment& axis, double radius, int part, int held) const {
  const double reach = kOwnReach * radius;
  return std::any_of(held_.begin(), held_.begin() + held, [&](const Held& h) {
    return (h.grasped && part >= jaws_.first && part < jaws_.end) ||
           (h.at - nearest_point(axis, h.at)).squaredNorm() < reach * reach;
  });
}

// What the tool holds beside this place makes a dent there that the surface does not show.
bool LocalBody::dented(const Vector3d& at, double radius, int held) const {
  const double reach = kDent * radius;
  return std::any_of(held_.begin(), held_.begin() + held,
                     [&](const Held& h) { return (h.at - at).squaredNorm() < reach * reach; });
}

BetweenJaws LocalBody::between(const OpenJaws& jaws) {
  obstacles_.begin(jaws, 0);
  for (int t = 0; t < state_.model.triangles; ++t) {
    const auto& [a, b, c] = state_.model.triangle[t];
    obstacles_.add({position_[a], position_[b], position_[c]});
  }
  return obstacles_.found();
}

void LocalBody::state(State& s) {
  Memory memory = state_;
  s.value(memory);
  s.all(position_);
  s.value(grasp_force_);
  reach_.state(s);
  if (!s.restoring()) return;
  const LocalModel& m = memory.model;
  const auto within = [](int count, int most) { return count >= 0 && count <= most; };
  bool good = within(m.contacts, LocalModel::kMaxContacts) && within(m.nodes, LocalModel::kMaxNodes) &&
              within(m.triangles, LocalModel::kMaxTriangles);
  for (int t = 0; good && t < m.triangles; ++t)
    for (const std::uint32_t n : m.triangle[t]) good = good && n < static_cast<std::uint32_t>(m.nodes);
  s.require(good, "the recorded state holds a local contact model that cannot be");
  state_ = memory;
  model_pose_ = tip_pose(trocar_, dofs_of(m.pose));
}

}  // namespace palpate
