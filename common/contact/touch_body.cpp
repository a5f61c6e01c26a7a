#include "common/contact/touch_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

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

bool TouchBody::adopt(const TouchContact& contact) {
  const int nodes = static_cast<int>(surface().positions().size());
  if (!by_mesh() || law_.full() ||
      !std::ranges::all_of(contact.anchor.nodes, [&](int n) { return n >= 0 && n < nodes; }))
    return false;
  contacts_.adopt(contact);
  return true;
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
