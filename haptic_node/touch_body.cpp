#include "haptic_node/touch_body.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "common/kernels/kernels.hpp"

namespace palpate {
namespace {

constexpr int whole_columns_from = 6;   // part of the touchable nodes, one in so many, from which whole columns are read
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

// A contact as plain bytes for the state that replay starts from.
struct StoredContact {
  int tool, sample, nodes[3];
  unsigned char face, touch;
  double weights[3], offset[3], normal[3], slip[3], force[3], point_force[9];
  int points;
};

void put(double* to, const Eigen::Vector3d& v) { std::memcpy(to, v.data(), sizeof(double[3])); }
Eigen::Vector3d get(const double* from) { return {from[0], from[1], from[2]}; }

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

// ---- collide ---------------------------------------------------------------------------------------------------

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

// ---- hold ------------------------------------------------------------------------------------------------------

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

// ---- force -----------------------------------------------------------------------------------------------------

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

// ---- state -----------------------------------------------------------------------------------------------------

std::size_t TouchBody::state_size() const { return surface_.state_size() + sizeof(int) + max_contacts * sizeof(StoredContact); }

void TouchBody::save(unsigned char* to) const {
  surface_.save(to);
  to += surface_.state_size();
  const int count = static_cast<int>(law_.contacts().size());
  std::memcpy(to, &count, sizeof count);
  to += sizeof count;
  std::memset(to, 0, max_contacts * sizeof(StoredContact));
  for (int i = 0; i < count; ++i) {
    const TouchContact& c = law_.contacts()[i];
    const std::span<const double> forces = law_.point_forces(i);
    StoredContact s{};
    s.tool = c.tool;
    s.sample = c.sample;
    std::copy(c.anchor.nodes.begin(), c.anchor.nodes.end(), s.nodes);
    s.face = c.face;
    s.touch = static_cast<unsigned char>(c.touch);
    put(s.weights, c.anchor.weights);
    put(s.offset, c.offset);
    put(s.normal, c.normal);
    put(s.slip, c.slip);
    put(s.force, c.force);
    std::copy(forces.begin(), forces.end(), s.point_force);
    s.points = static_cast<int>(forces.size()) / 3;
    std::memcpy(to, &s, sizeof s);
    to += sizeof s;
  }
}

void TouchBody::restore(const unsigned char* from, std::span<const MovingTool> tools) {
  surface_.restore(from);
  from += surface_.state_size();
  int count = 0;
  std::memcpy(&count, from, sizeof count);
  from += sizeof count;
  if (count < 0 || count > max_contacts) throw std::runtime_error("the state names an impossible number of contacts");
  law_.clear();
  for (int i = 0; i < count; ++i, from += sizeof(StoredContact)) {
    StoredContact s;
    std::memcpy(&s, from, sizeof s);
    const bool tool_known = s.tool >= 0 && s.tool < static_cast<int>(tools.size());
    if (!tool_known || s.sample < 0 || s.sample >= static_cast<int>(tools[s.tool].samples.size()) || s.touch > 2 ||
        (s.points != 1 && s.points != 3))
      throw std::runtime_error("the state holds a contact that this scene cannot have");
    for (int node : s.nodes)
      if (node < 0 || node >= map_.size()) throw std::runtime_error("the state names a surface node that the body lacks");
    TouchContact c{.tool = s.tool, .sample = s.sample, .face = s.face != 0, .touch = static_cast<Touch>(s.touch)};
    c.anchor = {{s.nodes[0], s.nodes[1], s.nodes[2]}, get(s.weights)};
    c.offset = get(s.offset);
    c.normal = get(s.normal);
    c.slip = get(s.slip);
    c.force = get(s.force);
    law_.add(c, std::span(s.point_force).first(3 * s.points));
  }
}

}  // namespace palpate
