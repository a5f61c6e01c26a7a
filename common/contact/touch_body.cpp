#include "common/contact/touch_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

// How far tissue under a contact that a peer kept may have moved from rest: what is pressed moves about as far as the
// tool reaches into the rest shape, what it rubs along or lies deeper in its dent somewhat farther.
constexpr double kMaxStretch = 2;  // of that depth
constexpr double kSlack = 1e-3;    // [m]

ContactLaw::Rule rule_of(const ContactSpec& contact) {
  return contact.rule == ContactRule::alpha ? ContactLaw::Rule::alpha : ContactLaw::Rule::barycentric;
}

}  // namespace

TouchBody::TouchBody(const SurfaceMap& map, Compliance<double> compliance, const StepSettings& settings,
                     ToolContacts::Options options)
    : map_(map),
      compliance_(std::move(compliance)),
      unloaded_(map_.position),
      response_(compliance_),
      surface_(map_, bucket_size(settings.contact, map_)),
      law_({response_, unloaded_}, rule_of(settings.contact), settings.contact.friction, kMaxContacts),
      contacts_(surface_, law_, parts_of(settings.tools), std::move(options)),
      own_(settings.tools.size()) {}

LawOutcome TouchBody::hold(std::span<const MovingTool> tools) {
  contacts_.aim(tools);
  const LawOutcome outcome = law_.solve();
  contacts_.settle(tools);
  return outcome;
}

LawOutcome TouchBody::touch(const ToolsInStep& in, std::span<ToolLoad> loads) {
  if (by_mesh()) collide(in.tools);
  const LawOutcome outcome = hold(in.tools);
  load(in.tools, own_);
  for (std::size_t t = 0; t < own_.size(); ++t) loads[t].add(own_[t]);
  return outcome;
}

void TouchBody::for_each_contact(const VisitContact& visit) const {
  for (const TouchContact& c : law_.contacts())
    if (c.touch != Touch::open) visit(c);
}

void TouchBody::for_each_force(const VisitForce& visit) const {
  law_.for_each_nodal_force([&](int contact, int node, const Eigen::Vector3d& f) {
    visit(law_.contacts()[contact].tool_point().tool, node, f);
  });
}

// A triangle that tools can touch, or one of its corners thrice.
bool TouchBody::has(const Anchor& anchor) const {
  const auto& n = anchor.nodes;
  const bool corner = n[0] == n[1] && n[0] == n[2];
  for (int t = 0; t < surface().triangle_count(); ++t) {
    const auto& of = surface().triangle(t);
    if (corner ? std::ranges::find(of, n[0]) != of.end() : of == n)
      return std::ranges::all_of(n, [this](int node) { return surface().touchable(node); });
  }
  return false;
}

// [m] of the tool in the rest shape: at the ends of its parts, and where they touch.
double TouchBody::deepest(const MovingTool& tool, std::span<const TouchContact> contacts) const {
  double deepest = 0;
  const auto look = [&](const Eigen::Vector3d& at, int part) {
    deepest = std::max(deepest, penetration({at, at}, tool.radius(part)));
  };
  for (int p = 0; p < tool.size(); ++p) look(tool.axis(p).start, p), look(tool.axis(p).end, p);
  for (const TouchContact& c : contacts)
    look(nearest_point(tool.axis(c.tool_point().part), c.target), c.tool_point().part);
  return deepest;
}

bool TouchBody::fits(const MovingTool& tool, std::span<const TouchContact> contacts) const {
  const auto room = static_cast<std::size_t>(law_.capacity()) - law_.contacts().size();
  if (contacts.empty()) return true;
  if (!by_mesh() || contacts.size() > room ||
      !std::ranges::all_of(contacts, [this](const TouchContact& c) { return has(c.anchor); }))
    return false;
  const double depth = deepest(tool, contacts);
  return depth > 0 && std::ranges::all_of(contacts, [&](const TouchContact& c) {
           return (anchor_position(c.anchor, surface().rest()) - c.target).norm() <= kMaxStretch * depth + kSlack;
         });
}

// Their forces follow from where they are; a peer's word on them is not taken.
void TouchBody::stand(std::span<const MovingTool> tools, int steps) {
  for (int i = 0; i < steps; ++i) {
    update_surface(tools);
    collide(tools);
    hold(tools);
  }
}

void TouchBody::adopt(std::span<const TouchContact> contacts) {
  for (const TouchContact& contact : contacts) contacts_.adopt(contact);
  law_.solve();
}

BetweenJaws TouchBody::between(const OpenJaws& jaws) {
  obstacles_.begin(jaws, wall_radius());
  const Eigen::Vector3d middle = jaws.pose * Eigen::Vector3d(0, 0, jaws.shape.jaw_length / 2);
  for (int t : surface().find(middle, middle, jaws.shape.jaw_length)) obstacles_.add(surface().corners(t));
  return obstacles_.found();
}

void TouchBody::grasp(const OpenJaws& jaws) {
  contacts_.grasp(jaws, [](int) { return true; });
}

double TouchBody::grasp_load(int tool) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const TouchContact& c : law_.contacts())
    if (c.is_by(tool) && c.grasped) sum += c.force;
  return sum.norm();
}

Eigen::Vector3d TouchBody::press_of(int tool) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const TouchContact& c : law_.contacts())
    if (c.is_by(tool) && c.touch != Touch::open && !c.grasped) sum += c.force.dot(c.normal) * c.normal;
  const double size = sum.norm();
  return size > 0 ? Eigen::Vector3d(sum / size) : Eigen::Vector3d::Zero();
}

void TouchBody::load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const {
  for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
    loads[t] = {.press = press_of(t)};
    for (const TouchContact& c : law_.contacts()) {
      if (!c.is_by(t) || c.touch == Touch::open) continue;
      loads[t].force -= c.force;
      loads[t].torque -= (c.at - tools[t].now.translation()).cross(c.force);
    }
  }
}

double TouchBody::penetration(const Segment& axis, double radius) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (int t = 0; t < surface().triangle_count(); ++t)
    nearest = std::min(nearest, closest_points(axis, surface().corners(t)).squared_distance);
  nearest = std::sqrt(nearest);
  const bool inside = surface().encloses(axis.start) || surface().encloses(axis.end);
  return inside ? radius + nearest : std::max(0.0, radius - nearest);
}

}  // namespace palpate
