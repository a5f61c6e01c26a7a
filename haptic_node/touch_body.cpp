#include "haptic_node/touch_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/kernels/kernels.hpp"

namespace palpate {
namespace {

constexpr double least_facing = 0.1;  // cosine between a sticking contact's normal and the surface's, below which it slides
constexpr double margin_share = 0.1;  // of a sphere's radius or a mean edge: what is this near is watched before it is touched

double mean_edge(const SurfaceMap& map) {
  double sum = 0;
  for (const auto& t : map.triangles)
    for (int v = 0; v < 3; ++v) sum += (map.position[t[v]] - map.position[t[(v + 1) % 3]]).norm();
  return sum / (3.0 * map.triangles.size());
}

double bucket_size(const SurfaceMap& map, const Contact& contact) {
  return contact.bucket_size > 0 ? contact.bucket_size : 2 * mean_edge(map);
}

ContactLaw::Rule rule_of(const Contact& contact) {
  return contact.rule == "alpha" ? ContactLaw::Rule::alpha : ContactLaw::Rule::barycentric;
}

// Direction from a sphere's centre to a surface point, kept on the tool's side: a point that has come to lie behind
// the centre is led round to the front.
Eigen::Vector3d direction_to(const Eigen::Vector3d& point, const Eigen::Vector3d& centre, double radius, const Eigen::Vector3d& side) {
  const Eigen::Vector3d d = point - centre;
  const double ahead = d.dot(side);
  if (ahead > 0) return d.normalized();
  const Eigen::Vector3d lateral = d - ahead * side;
  const double left = radius * radius - lateral.squaredNorm();
  return left > 0 ? Eigen::Vector3d((lateral + std::sqrt(left) * side) / radius) : side;
}

}  // namespace

TouchBody::TouchBody(const Archive& archive, const Scene& scene, int body)
    : map_(archive.surface),
      compliance_(archive, Compliance<double>::Rows::touchable),
      surface_(map_, bucket_size(map_, scene.contact)),
      law_(compliance_, map_.position, rule_of(scene.contact), scene.contact.friction, max_contacts),
      body_edge_(mean_edge(map_)),
      vertex_stamp_(map_.size(), 0) {
  const Body& b = scene.bodies[body];
  for (const auto& t : map_.triangles) {
    double edges = 0;
    for (int v = 0; v < 3; ++v) edges += (map_.position[t[v]] - map_.position[t[(v + 1) % 3]]).norm();
    mean_edge_.push_back(edges / 3);
  }
  if (b.nonlinear) nonlinear_ = make_quasi_nonlinear(b, archive);
  columns_.reserve(27 * max_contacts);
  coefficients_.reserve(27 * max_contacts);
  displacement_.reserve(3 * map_.size());
  of_tool_.reserve(3 * map_.size());
  whole_.assign(compliance_.stride(), 0.0);
  std::size_t spheres = 0;
  for (const Tool& t : scene.tools) spheres += sample_tool(t.radius, t.shaft_radius, t.shaft_length).size();
  near_.reserve(spheres * map_.triangles.size());
  near_end_.reserve(spheres);
}

double TouchBody::margin(double radius) const { return margin_share * std::min(radius, body_edge_); }

double TouchBody::reach(const MovingTool& moving, int sample) const {
  const double motion = (moving.centre(moving.now, sample) - moving.centre(moving.before, sample)).norm();
  return moving.samples[sample].radius + margin(moving.samples[sample].radius) + motion;
}

// Into the tissue, by the deformed surface's own normal at the anchor: the side from which a tool may touch it.
Eigen::Vector3d TouchBody::inward(const TouchContact& c) const {
  if (!c.face) return -surface_.vertex_normal(c.anchor.nodes[0]);
  const auto& x = surface_.positions();
  const auto& n = c.anchor.nodes;
  return -(x[n[1]] - x[n[0]]).cross(x[n[2]] - x[n[0]]).normalized();
}

void TouchBody::aim(TouchContact& c, const MovingTool& moving) const {
  const Eigen::Vector3d centre = moving.centre(moving.now, c.sample), into = inward(c);
  const double radius = moving.samples[c.sample].radius;
  c.target = moving.now * c.offset;
  const Eigen::Vector3d outward_of_tool = (c.target - centre).normalized();
  if (c.touch == Touch::sticking && outward_of_tool.dot(into) > least_facing) {
    c.normal = outward_of_tool;
  } else {
    if (c.touch == Touch::sticking) c.touch = Touch::sliding;  // the tool has turned away from its anchor
    c.normal = direction_to(anchor_position(c.anchor, surface_.positions()), centre, radius, into);
    if (c.touch == Touch::open) c.target = centre + radius * c.normal;
  }
  c.plane = c.normal.dot(centre) + radius;
}

LawOutcome TouchBody::hold(std::span<const MovingTool> tools) {
  for (TouchContact& c : law_.contacts()) aim(c, tools[c.tool]);
  const LawOutcome outcome = law_.solve();
  settle(tools);
  return outcome;
}

// After the solve: sliding contacts move on along the sphere, those that have opened and gone are dropped.
void TouchBody::settle(std::span<const MovingTool> tools) {
  for (int i = static_cast<int>(law_.contacts().size()) - 1; i >= 0; --i) {
    TouchContact& c = law_.contacts()[i];
    const MovingTool& moving = tools[c.tool];
    const double radius = moving.samples[c.sample].radius;
    const Eigen::Vector3d centre = moving.centre(moving.now, c.sample);
    if (c.touch == Touch::open) {
      const bool gone = (anchor_position(c.anchor, surface_.positions()) - centre).norm() > reach(moving, c.sample) + margin(radius);
      if (c.face || gone) law_.remove(i);
      continue;
    }
    if (c.touch == Touch::sliding) {
      c.offset = moving.now.inverse() * Eigen::Vector3d(centre + radius * (c.position - centre).normalized());
    } else {
      c.offset = moving.now.inverse() * c.target;
    }
  }
}

Eigen::Vector3d TouchBody::press_of(int tool) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const TouchContact& c : law_.contacts())
    if (c.tool == tool && c.touch != Touch::open) sum += c.force.dot(c.normal) * c.normal;
  const double size = sum.norm();
  return size > 0 ? Eigen::Vector3d(sum / size) : Eigen::Vector3d::Zero();
}

void TouchBody::load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const {
  for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
    loads[t] = {.press = press_of(t)};
    Eigen::Vector3d on_tissue = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
    for (const TouchContact& c : law_.contacts()) {
      if (c.tool != t || c.touch == Touch::open) continue;
      const Eigen::Vector3d at = tools[t].centre(tools[t].now, c.sample) + tools[t].samples[c.sample].radius * c.normal;
      on_tissue += c.force;
      moment += (at - tools[t].now.translation()).cross(c.force);
    }
    const double scale = nonlinear_ ? nonlinear_->force_scale(on_tissue.dot(loads[t].press)) : 1.0;
    loads[t].force = -scale * on_tissue;
    loads[t].torque = -scale * moment;
  }
}

double TouchBody::penetration(const Eigen::Vector3d& centre, double radius) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (int t = 0; t < surface_.triangle_count(); ++t) nearest = std::min(nearest, closest_point(centre, surface_.corners(t)).squared_distance);
  nearest = std::sqrt(nearest);
  return surface_.encloses(centre) ? radius + nearest : std::max(0.0, radius - nearest);
}

}  // namespace palpate
