#include "common/contact/tool_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace palpate {
namespace {

constexpr double least_facing = 0.1;  // cosine between a sticking contact's normal and the surface's, below which it slides
constexpr double margin_share = 0.1;  // of a sphere's radius or a mean edge: what is this near is watched before it is touched

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

std::size_t spheres_of(const Scene& scene) {
  std::size_t spheres = 0;
  for (const Tool& t : scene.tools) spheres += sample_tool(t.radius, t.shaft_radius, t.shaft_length).size();
  return spheres;
}

double mean_edge(const SurfaceMap& map) {
  double sum = 0;
  for (const auto& t : map.triangles)
    for (int v = 0; v < 3; ++v) sum += (map.position[t[v]] - map.position[t[(v + 1) % 3]]).norm();
  return sum / (3.0 * map.triangles.size());
}

ToolContacts::ToolContacts(const SurfaceMap& map, double bucket_size, ContactLaw& law, std::size_t spheres)
    : law_(law),
      surface_(map, bucket_size),
      touchable_(map.touchable),
      nodes_(map.size()),
      body_edge_(palpate::mean_edge(map)),
      vertex_stamp_(map.size(), 0) {
  for (const auto& t : map.triangles) {
    double edges = 0;
    for (int v = 0; v < 3; ++v) edges += (map.position[t[v]] - map.position[t[(v + 1) % 3]]).norm();
    mean_edge_.push_back(edges / 3);
  }
  near_.reserve(spheres * map.triangles.size());
  near_end_.reserve(spheres);
}

double ToolContacts::margin(double radius) const { return margin_share * std::min(radius, body_edge_); }

double ToolContacts::reach(const MovingTool& moving, int sample) const {
  const double motion = (moving.centre(moving.now, sample) - moving.centre(moving.before, sample)).norm();
  return moving.samples[sample].radius + margin(moving.samples[sample].radius) + motion;
}

// Into the tissue, by the deformed surface's own normal at the anchor: the side from which a tool may touch it.
Eigen::Vector3d ToolContacts::inward(const TouchContact& c) const {
  if (!c.face) return -surface_.vertex_normal(c.anchor.nodes[0]);
  const auto& x = surface_.positions();
  const auto& n = c.anchor.nodes;
  return -(x[n[1]] - x[n[0]]).cross(x[n[2]] - x[n[0]]).normalized();
}

void ToolContacts::aim(TouchContact& c, const MovingTool& moving) const {
  const Eigen::Vector3d centre = moving.centre(moving.now, c.sample), into = inward(c);
  const double radius = moving.samples[c.sample].radius;
  c.target = moving.now * c.offset;
  if (c.grasped) return;
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

void ToolContacts::aim(std::span<const MovingTool> tools) {
  for (TouchContact& c : law_.contacts()) aim(c, tools[c.tool]);
}

void ToolContacts::settle(std::span<const MovingTool> tools) {
  for (int i = static_cast<int>(law_.contacts().size()) - 1; i >= 0; --i) {
    TouchContact& c = law_.contacts()[i];
    if (c.grasped) continue;
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

void ToolContacts::take_in_jaws(int tool, const Eigen::Isometry3d& pose, const Anchor& anchor, bool face) {
  if (law_.full()) return;
  TouchContact c{.tool = tool, .face = face, .grasped = true, .touch = Touch::sticking};
  c.anchor = anchor;
  c.offset = pose.inverse() * anchor_position(anchor, surface_.positions());
  c.normal = pose.linear().col(2);
  law_.add(c);
}

// The surface point nearest to the jaws' middle, where triangles are larger than they are.
bool ToolContacts::grasp_nearest(int tool, const Eigen::Isometry3d& pose, double length) {
  const Eigen::Vector3d middle = pose * Eigen::Vector3d(0, 0, 0.5 * length);
  double least = 0.25 * length * length;
  std::optional<Anchor> nearest;
  for (int t : surface_.find(middle, middle, length)) {
    const ClosestPoint p = closest_point(middle, surface_.corners(t));
    if (p.squared_distance >= least) continue;
    least = p.squared_distance;
    nearest = {surface_.triangle(t), p.weights};
  }
  if (nearest) take_in_jaws(tool, pose, *nearest, true);
  return nearest.has_value();
}

void ToolContacts::let_go(int tool) {
  for (int i = static_cast<int>(law_.contacts().size()) - 1; i >= 0; --i)
    if (law_.contacts()[i].grasped && law_.contacts()[i].tool == tool) law_.remove(i);
}

}  // namespace palpate
