// How ToolContacts finds what the tools touch.
#include <algorithm>
#include <limits>

#include "common/contact/tool_contacts.hpp"

namespace palpate {

std::span<const int> ToolContacts::mark(std::span<const MovingTool> tools) {
  surface_.begin_update();
  for (const TouchContact& c : law_.contacts())
    for (int v = 0; v < 3; ++v)
      if (c.anchor.weights[v] != 0) surface_.mark_node(c.anchor.nodes[v]);
  near_.clear();
  near_end_.clear();
  for (const MovingTool& tool : tools)
    for (int s = 0; s < static_cast<int>(tool.samples.size()); ++s) {
      const std::span<const int> found = surface_.find(tool.centre(tool.before, s), tool.centre(tool.now, s), reach(tool, s) + body_edge_);
      surface_.mark_triangles(found);
      near_.insert(near_.end(), found.begin(), found.end());
      near_end_.push_back(near_.size());
    }
  return surface_.marked();
}

void ToolContacts::collide(std::span<const MovingTool> tools) {
  std::size_t begin = 0, sphere = 0;
  for (int t = 0; t < static_cast<int>(tools.size()); ++t)
    for (int s = 0; s < static_cast<int>(tools[t].samples.size()); ++s) {
      const std::size_t end = near_end_[sphere++];
      collide_sample(tools, t, s, std::span(near_).subspan(begin, end - begin));
      begin = end;
    }
}

const TouchContact* ToolContacts::held_by(int tool, int sample) const {
  for (const TouchContact& c : law_.contacts())
    if (c.tool == tool && c.sample == sample && !c.grasped && c.touch != Touch::open) return &c;
  return nullptr;
}

void ToolContacts::collide_sample(std::span<const MovingTool> tools, int tool, int sample, std::span<const int> near) {
  const MovingTool& moving = tools[tool];
  const Eigen::Vector3d now = moving.centre(moving.now, sample);
  const double within = reach(moving, sample);
  if (add_crossing(moving, tool, sample) || near.empty()) return;
  const double radius = moving.samples[sample].radius;
  add_vertices(now, radius, within, tool, sample, near);
  add_face(now, radius, within, tool, sample, near);
}

// The sphere's centre has passed through the surface within this step: the contact is made where it passed.
bool ToolContacts::add_crossing(const MovingTool& moving, int tool, int sample) {
  const Eigen::Vector3d before = moving.centre(moving.before, sample), now = moving.centre(moving.now, sample);
  double earliest = std::numeric_limits<double>::infinity();
  int struck = -1;
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
  for (int t : surface_.find(before, now, 0)) {
    const auto hit = sweep_point(before, now, surface_.previous_corners(t), surface_.corners(t));
    if (!hit || !hit->from_outside || hit->time >= earliest) continue;
    earliest = hit->time;
    struck = t;
    weights = hit->weights;
  }
  if (struck < 0 || law_.full()) return false;
  const Eigen::Vector3d into = -surface_.triangle_normal(struck).normalized();
  const TouchContact* held = held_by(tool, sample);
  if (held && held->normal.dot(into) > 0) return false;
  TouchContact c{.tool = tool, .sample = sample, .face = true};
  c.anchor = {surface_.triangle(struck), weights};
  c.normal = into;
  law_.add(c);
  return true;
}

// Where triangles are smaller than the sphere, their vertices carry the contact: the force then belongs to the patch
// under the sphere and not to the mesh.
void ToolContacts::add_vertices(const Eigen::Vector3d& centre, double radius, double within, int tool, int sample,
                             std::span<const int> near) {
  ++vertex_clock_;
  const TouchContact* held = held_by(tool, sample);
  const bool has_side = held != nullptr;
  const Eigen::Vector3d side = held ? held->normal : Eigen::Vector3d::Zero();  // copied: adding moves the contacts
  for (const TouchContact& c : law_.contacts())
    if (c.tool == tool && (c.sample == sample || c.grasped) && !c.face) vertex_stamp_[c.anchor.nodes[0]] = vertex_clock_;
  for (int t : near)
    for (int node : surface_.triangle(t)) {
      const bool seen = node >= touchable_ || vertex_stamp_[node] == vertex_clock_;
      if (seen || mean_edge_[t] > radius || law_.full()) continue;
      vertex_stamp_[node] = vertex_clock_;
      const Eigen::Vector3d away = centre - surface_.positions()[node];
      if (away.squaredNorm() > within * within) continue;
      const Eigen::Vector3d outward = surface_.vertex_normal(node);
      const bool in_front = away.dot(outward) > 0;
      if (!in_front && !(has_side && outward.dot(side) < 0)) continue;
      TouchContact c{.tool = tool, .sample = sample};
      c.anchor = {{node, node, node}, Eigen::Vector3d::UnitX()};
      c.normal = in_front ? Eigen::Vector3d(-outward) : side;
      law_.add(c);
    }
}

// Where triangles are larger than the sphere, it touches between their vertices, at the surface point nearest to its
// centre (TVCG99 sec. 5, sub-triangular precision). One point a sphere: a second one in the same dent would depend on
// the first.
void ToolContacts::add_face(const Eigen::Vector3d& centre, double radius, double within, int tool, int sample, std::span<const int> near) {
  int face = -1;
  bool vertices_carry = false;
  for (int i = 0; i < static_cast<int>(law_.contacts().size()); ++i) {
    const TouchContact& c = law_.contacts()[i];
    if (c.tool != tool || c.sample != sample || c.grasped) continue;
    if (c.face) face = i;
    vertices_carry |= !c.face && c.touch != Touch::open;
  }
  if (face >= 0 && vertices_carry) law_.remove(face);
  if (vertices_carry) return;
  if (face >= 0) {
    if (law_.contacts()[face].touch != Touch::sticking) follow(face, centre, near);
    return;
  }
  if (law_.full()) return;
  double least = within * within;
  int nearest = -1;
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
  for (int t : near) {
    if (mean_edge_[t] <= radius || taken_by_other(tool, sample, surface_.triangle(t))) continue;
    const Triangle corners = surface_.corners(t);
    const ClosestPoint p = closest_point(centre, corners);
    const Eigen::Vector3d at = p.weights[0] * corners[0] + p.weights[1] * corners[1] + p.weights[2] * corners[2];
    if (p.squared_distance >= least || (centre - at).dot(surface_.triangle_normal(t)) <= 0) continue;
    least = p.squared_distance;
    nearest = t;
    weights = p.weights;
  }
  if (nearest < 0) return;
  TouchContact c{.tool = tool, .sample = sample, .face = true};
  c.anchor = {surface_.triangle(nearest), weights};
  c.normal = -surface_.triangle_normal(nearest).normalized();
  law_.add(c);
}

// A triangle cannot follow several spheres of a shaft at once: the first to touch it has it.
bool ToolContacts::taken_by_other(int tool, int sample, const std::array<int, 3>& nodes) const {
  for (const TouchContact& c : law_.contacts())
    if (c.tool == tool && c.sample != sample && c.face && !c.grasped && c.anchor.nodes == nodes) return true;
  return false;
}

// A sliding contact keeps to the nearest point of its triangle and goes over to a neighbour only across the border
// that it has reached: in the dent that it makes, other triangles may be nearer.
void ToolContacts::follow(int contact, const Eigen::Vector3d& centre, std::span<const int> near) {
  const Anchor& now = law_.contacts()[contact].anchor;
  const auto& x = surface_.positions();
  const ClosestPoint own = closest_point(centre, {x[now.nodes[0]], x[now.nodes[1]], x[now.nodes[2]]});
  Anchor followed{now.nodes, own.weights};
  double least = own.squared_distance * (1 - 1e-9);
  for (int t : near) {
    const auto& nodes = surface_.triangle(t);
    bool across = own.weights.minCoeff() <= 0 && nodes != now.nodes;
    for (int v = 0; v < 3; ++v) across &= own.weights[v] <= 0 || std::find(nodes.begin(), nodes.end(), now.nodes[v]) != nodes.end();
    if (!across || taken_by_other(law_.contacts()[contact].tool, law_.contacts()[contact].sample, nodes)) continue;
    const ClosestPoint p = closest_point(centre, surface_.corners(t));
    if (p.squared_distance >= least) continue;
    least = p.squared_distance;
    followed = {nodes, p.weights};
  }
  law_.move_anchor(contact, followed);
}

}  // namespace palpate
