#include "common/contact/patch/patch_touch.hpp"

#include <algorithm>

#include "common/contact/patch/fewer_forces.hpp"
#include "common/contact/patch/patch_parts.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// [m] of a node under a force on another one; zero beyond the touchable ones.
Vector3d moved_by(const Compliance<double>& c, int node, int from, const Vector3d& force) {
  if (node >= c.row_nodes() || from >= c.column_nodes()) return Vector3d::Zero();
  return c.block(node, from) * force;
}

}  // namespace

PatchTouch::PatchTouch(const SurfaceMap& map, const Compliance<double>& compliance, const HalfSpace& half_space,
                       const StepSettings& settings, double resolved, const std::optional<CreepStep>& creep)
    : compliance_(compliance),
      friction_(settings.contact.friction),
      way_out_(Patch::kWayOut * settings.dt),
      surface_(map),
      grids_(half_space, widest_patch(map)) {
  double largest = 0;
  for (const PatchPart& part : patch_parts(settings.tools, !creep)) {
    parts_.push_back({part.tool, part.part, Patch(grids_.of(part.radius, part.length), creep)});
    parts_.back().forces.reserve(Patch::kMaxNodes);
    largest = std::max(largest, std::min(part.radius, widest_patch(map)));
  }
  near_field_ = std::make_unique<NearField>(surface_, compliance, half_space, largest, resolved);
  moved_.reserve(Patch::kMaxNodes);
}

void PatchTouch::for_each_force(const VisitForce& visit) const {
  for (const Part& p : parts_)
    for (const PatchForce& f : p.forces) visit(p.tool, f.node, f.force);
}

Vector3d PatchTouch::displacement(int node) const {
  Vector3d sum = Vector3d::Zero();
  for (const Part& p : parts_)
    for (const PatchForce& f : p.forces) sum += moved_by(compliance_, node, f.node, f.force);
  return sum;
}

void PatchTouch::add_displacement(int from, const Vector3d& force, std::span<const int> nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) moved_[i] += moved_by(compliance_, nodes[i], from, force);
}

// One patch after another, each against the others' newest forces.
bool PatchTouch::touch(std::span<const MovingTool> tools, const Beside& beside) {
  bool settled = true;
  for (Part& own : parts_) {
    std::span<const int> nodes;
    if (beside.holds(own.tool))
      own.patch.lift();
    else
      nodes = press(own, tools[own.tool], beside);
    load_body(own);
    if (beside.past && !nodes.empty()) remember(own, nodes);
    settled &= nodes.empty() || own.patch.settled();
  }
  return settled;
}

// A part that goes over a rim may leave one side of the body and stand deep in the other: it comes in from no depth on.
std::span<const int> PatchTouch::lay(Part& own, const Patch::Ground& ground, const MovingTool& tool) const {
  const bool touched = own.patch.touches(), left = own.left;
  const std::span<const int> nodes = own.patch.lay(ground, tool.before, tool.now, tool.axis(own.part));
  own.left = touched && nodes.empty();
  if (!touched && left && !nodes.empty()) own.ease = own.patch.depth();
  own.ease = nodes.empty() ? 0 : std::max(own.ease - way_out_, 0.0);
  return nodes;
}

std::span<const int> PatchTouch::press(Part& own, const MovingTool& tool, const Beside& beside) {
  const Patch::Ground ground{surface_, *near_field_, friction_};
  const std::span<const int> nodes = lay(own, ground, tool);
  if (nodes.empty()) return nodes;
  moved_.assign(nodes.size(), Vector3d::Zero());
  if (beside.past) beside.past(nodes, {moved_.data()->data(), 3 * nodes.size()});
  beside.others([&](int, int node, const Vector3d& force) { add_displacement(node, force, nodes); });
  meet_others(own, nodes, static_cast<bool>(beside.past));
  own.patch.press(ground, moved_, own.ease);
  own.offset = tool.to_part(own.part, own.patch.at());
  return nodes;
}

// A patch lies in the other's dent, which the mesh is too coarse to show. Of tissue that relaxes the past knows the
// nodes' alone.
void PatchTouch::meet_others(Part& own, std::span<const int> nodes, bool relaxes) {
  for (const Part& other : parts_) {
    if (&other == &own || !other.patch.touches()) continue;
    if (!relaxes) own.patch.lie_beside(other.patch);
    for (const PatchForce& f : other.forces) {
      if (relaxes) {
        add_displacement(f.node, f.force, nodes);
        continue;
      }
      for (std::size_t i = 0; i < nodes.size(); ++i) moved_[i] += near_field_->between(nodes[i], f.node) * f.force;
    }
  }
}

void PatchTouch::load_body(Part& part) {
  part.forces.assign(part.patch.forces().begin(), part.patch.forces().end());
  hand_to_fewer(kMaxForces, surface_.map().position, part.forces);
}

void PatchTouch::remember(Part& part, std::span<const int> nodes) {
  moved_.assign(nodes.size(), Vector3d::Zero());
  for (const PatchForce& f : part.forces) add_displacement(f.node, f.force, nodes);
  part.patch.remember(moved_);
}

bool PatchTouch::has(int tool, int part) const {
  return std::ranges::any_of(parts_, [&](const Part& p) { return p.tool == tool && p.part == part; });
}

Vector3d PatchTouch::pressing(int tool) const {
  Vector3d sum = Vector3d::Zero();
  for (const Part& p : parts_)
    if (p.tool == tool && p.patch.touches()) sum += p.patch.pressure();
  return sum;
}

void PatchTouch::load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const {
  for (const Part& p : parts_) {
    if (!p.patch.touches()) continue;
    loads[p.tool].force -= p.patch.force();
    loads[p.tool].torque -= (p.patch.at() - tools[p.tool].now.translation()).cross(p.patch.force());
  }
}

void PatchTouch::for_each_contact(const BodyPart::VisitContact& visit) const {
  for (const Part& p : parts_) {
    if (!p.patch.touches()) continue;
    TouchContact c{.by = ToolPoint{.tool = p.tool, .part = p.part, .offset = p.offset}, .face = true};
    c.touch = p.patch.sticks() ? Touch::sticking : Touch::sliding;
    c.anchor = p.patch.anchor();
    c.normal = p.patch.normal();
    c.force = p.patch.force();
    c.at = c.target = p.patch.at();
    visit(c);
  }
}

void PatchTouch::adopt(const TouchContact& contact) {
  std::ranges::find_if(parts_, [&](const Part& p) {
    return contact.is_by(p.tool, p.part);
  })->patch.resume(contact.force);
}

void PatchTouch::state(State& s) {
  for (Part& p : parts_) {
    p.patch.state(s);
    s.value(p.offset);
    s.value(p.left);
    s.value(p.ease);
    s.require(p.patch.fits(surface_.map().size()), "the state holds a patch that this body cannot have");
    if (s.restoring()) load_body(p);
  }
}

}  // namespace palpate
