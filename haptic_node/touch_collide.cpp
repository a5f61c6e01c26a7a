// How a TouchBody finds what the tools touch.
#include <algorithm>
#include <limits>

#include "common/kernels/kernels.hpp"
#include "haptic_node/touch_body.hpp"

namespace palpate {
namespace {

constexpr int whole_columns_from = 6;   // part of the touchable nodes, one in so many, from which whole columns are read

}  // namespace

void TouchBody::collide(std::span<const MovingTool> tools) {
  update_surface(tools);
  std::size_t begin = 0, sphere = 0;
  for (int t = 0; t < static_cast<int>(tools.size()); ++t)
    for (int s = 0; s < static_cast<int>(tools[t].samples.size()); ++s) {
      const std::size_t end = near_end_[sphere++];
      collide_sample(tools, t, s, std::span(near_).subspan(begin, end - begin));
      begin = end;
    }
}

void TouchBody::update_surface(std::span<const MovingTool> tools) {
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
  displacement_.assign(3 * surface_.marked().size(), 0.0);
  if (!nonlinear_) {
    superpose(-1, displacement_);
  } else {
    for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
      superpose(t, of_tool_);
      const Eigen::Vector3d press = press_of(t);
      for (std::size_t i = 0; i < surface_.marked().size(); ++i) {
        const Eigen::Vector3d u = Eigen::Map<const Eigen::Vector3d>(of_tool_.data() + 3 * i);
        Eigen::Map<Eigen::Vector3d>(displacement_.data() + 3 * i) += nonlinear_->correct(u, press);
      }
    }
    // What is held stays where it is held.
    superpose(-1, of_tool_);
    for (std::size_t i = 0; i < surface_.marked().size(); ++i)
      for (const TouchContact& c : law_.contacts())
        if (c.touch != Touch::open && (c.anchor.nodes[0] == surface_.marked()[i] || (c.face && (c.anchor.nodes[1] == surface_.marked()[i] ||
                                                                                              c.anchor.nodes[2] == surface_.marked()[i]))))
          std::copy_n(of_tool_.begin() + 3 * i, 3, displacement_.begin() + 3 * i);
  }
  surface_.move_marked(displacement_);
}

// u = sum C f over the contacts of one tool, or of all (-1), at the marked nodes.
void TouchBody::superpose(int tool, std::vector<double>& displacement) {
  columns_.clear();
  coefficients_.clear();
  law_.for_each_nodal_force([&](int contact, int node, const Eigen::Vector3d& f) {
    if (node >= compliance_.column_nodes() || (tool >= 0 && law_.contacts()[contact].tool != tool)) return;
    for (int axis = 0; axis < 3; ++axis) {
      columns_.push_back(compliance_.column(node, axis));
      coefficients_.push_back(f[axis]);
    }
  });
  const std::span<const int> marked = surface_.marked();
  const int count = static_cast<int>(columns_.size());
  displacement.resize(3 * marked.size());
  // Reading whole columns beats picking from them once a good part of the nodes is asked for.
  if (marked.size() * whole_columns_from < static_cast<std::size_t>(map_.touchable)) {
    kernels::active().combine_nodes_d(columns_.data(), coefficients_.data(), count, marked.data(), static_cast<int>(marked.size()),
                                      displacement.data());
    return;
  }
  kernels::active().combine_d(columns_.data(), coefficients_.data(), count, 3 * map_.touchable, whole_.data());
  for (std::size_t i = 0; i < marked.size(); ++i) std::copy_n(whole_.data() + 3 * marked[i], 3, displacement.data() + 3 * i);
}

const TouchContact* TouchBody::held_by(int tool, int sample) const {
  for (const TouchContact& c : law_.contacts())
    if (c.tool == tool && c.sample == sample && c.touch != Touch::open) return &c;
  return nullptr;
}

void TouchBody::collide_sample(std::span<const MovingTool> tools, int tool, int sample, std::span<const int> near) {
  const MovingTool& moving = tools[tool];
  const Eigen::Vector3d now = moving.centre(moving.now, sample);
  const double within = reach(moving, sample);
  if (add_crossing(moving, tool, sample) || near.empty()) return;
  const double radius = moving.samples[sample].radius;
  add_vertices(now, radius, within, tool, sample, near);
  add_face(now, radius, within, tool, sample, near);
}

// The sphere's centre has passed through the surface within this step: the contact is made where it passed.
bool TouchBody::add_crossing(const MovingTool& moving, int tool, int sample) {
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
void TouchBody::add_vertices(const Eigen::Vector3d& centre, double radius, double within, int tool, int sample,
                             std::span<const int> near) {
  ++vertex_clock_;
  const TouchContact* held = held_by(tool, sample);
  const bool has_side = held != nullptr;
  const Eigen::Vector3d side = held ? held->normal : Eigen::Vector3d::Zero();  // copied: adding moves the contacts
  for (const TouchContact& c : law_.contacts())
    if (c.tool == tool && c.sample == sample && !c.face) vertex_stamp_[c.anchor.nodes[0]] = vertex_clock_;
  for (int t : near)
    for (int node : surface_.triangle(t)) {
      const bool seen = node >= map_.touchable || vertex_stamp_[node] == vertex_clock_;
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
void TouchBody::add_face(const Eigen::Vector3d& centre, double radius, double within, int tool, int sample, std::span<const int> near) {
  int face = -1;
  bool vertices_carry = false;
  for (int i = 0; i < static_cast<int>(law_.contacts().size()); ++i) {
    const TouchContact& c = law_.contacts()[i];
    if (c.tool != tool || c.sample != sample) continue;
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
bool TouchBody::taken_by_other(int tool, int sample, const std::array<int, 3>& nodes) const {
  for (const TouchContact& c : law_.contacts())
    if (c.tool == tool && c.sample != sample && c.face && c.anchor.nodes == nodes) return true;
  return false;
}

// A sliding contact keeps to the nearest point of its triangle and goes over to a neighbour only across the border
// that it has reached: in the dent that it makes, other triangles may be nearer.
void TouchBody::follow(int contact, const Eigen::Vector3d& centre, std::span<const int> near) {
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
