// How ToolContacts finds what the tools touch.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "common/contact/tool_contacts.hpp"

namespace palpate {
namespace {

constexpr double kSideWithin =
    2;  // radii along a segment within which a contact says on which side of the tissue it is

}  // namespace

std::span<const int> ToolContacts::look(std::span<const MovingTool> tools) {
  near_.clear();
  near_end_.clear();
  for (const MovingTool& tool : tools)
    for (int p = 0; p < tool.size(); ++p) {
      const std::span<const int> found = surface_.find(tool.axis_before(p), tool.axis(p), reach(tool, p) + body_edge_);
      near_.insert(near_.end(), found.begin(), found.end());
      near_end_.push_back(near_.size());
    }
  return near_;
}

std::span<const int> mark(TouchSurface& surface, ToolContacts& contacts, const ContactLaw& law,
                          std::span<const MovingTool> tools) {
  surface.begin_update();
  for (const TouchContact& c : law.contacts())
    for (int v = 0; v < 3; ++v)
      if (c.anchor.weights[v] != 0) surface.mark_node(c.anchor.nodes[v]);
  surface.mark_triangles(contacts.look(tools));
  return surface.marked();
}

void ToolContacts::collide(std::span<const MovingTool> tools) {
  std::size_t begin = 0, at = 0;
  for (int t = 0; t < static_cast<int>(tools.size()); ++t)
    for (int p = 0; p < tools[t].size(); ++p) {
      const std::size_t end = near_end_[at++];
      collide_part(tools[t], t, p, std::span(near_).subspan(begin, end - begin));
      begin = end;
    }
}

void ToolContacts::collide_part(const MovingTool& moving, int tool, int part, std::span<const int> near) {
  const bool sphere = moving.parts[part].length == 0;
  if (options_.elsewhere) {
    own_near_.clear();
    std::ranges::copy_if(near, std::back_inserter(own_near_), [&](int t) { return !is_left_out(tool, part, t); });
    near = own_near_;
    if (near.empty()) return;
  }
  const bool crossed = sphere ? add_crossing(moving, tool, part) : add_crossings(moving, tool, part);
  if (near.empty() || (sphere && crossed)) return;
  add_vertices(moving, tool, part, near);
  sphere ? add_face(moving, tool, part, near) : add_faces(moving, tool, part, near);
}

// The contact of a part that carries force and lies nearest to a place along it [m], if one does so within a distance
// [m]. Of a sphere the oldest.
const TouchContact* ToolContacts::held_near(const MovingTool& moving, int tool, int part, double place,
                                            double within) const {
  const TouchContact* nearest = nullptr;
  for (const TouchContact& c : law_.contacts()) {
    if (!c.is_by(tool, part) || c.grasped || c.touch == Touch::open) continue;
    const double away = std::abs(std::clamp(c.tool_point().offset.z(), 0.0, moving.parts[part].length) - place);
    if (away > within || (nearest && away >= within)) continue;
    nearest = &c;
    within = away;
  }
  return nearest;
}

// A sphere's centre has passed through the surface within this step: the contact is made where it passed.
bool ToolContacts::add_crossing(const MovingTool& moving, int tool, int part) {
  const Eigen::Vector3d before = moving.axis_before(part).start, now = moving.axis(part).start;
  Crossing first;
  for (int t : surface_.find(before, now, 0))
    if (!is_left_out(tool, part, t))
      first.meet(t, sweep_point(before, now, surface_.previous_corners(t), surface_.corners(t)));
  return first.triangle >= 0 && add_at(first, moving, tool, part, 0);
}

// `place` [m]: along the part's axis.
bool ToolContacts::add_at(const Crossing& crossing, const MovingTool& moving, int tool, int part, double place) {
  if (law_.full()) return false;
  const Eigen::Vector3d into = -surface_.triangle_normal(crossing.triangle).normalized();
  const TouchContact* held =
      held_near(moving, tool, part, place, std::max(radius(moving, part), mean_edge_[crossing.triangle]));
  if (held && held->normal.dot(into) > 0) return false;
  const double soft = face_softness(tool, radius(moving, part));
  TouchContact c{.by = ToolPoint{.tool = tool, .part = part, .softness = soft}, .face = true};
  c.anchor = {surface_.triangle(crossing.triangle), crossing.weights};
  c.tool_point().offset = {0, 0, place};
  c.normal = into;
  law_.add(c);
  return true;
}

// Where triangles are smaller than the part's radius, their vertices carry the contact: the force then belongs to the
// patch under the part and not to the mesh.
void ToolContacts::add_vertices(const MovingTool& moving, int tool, int part, std::span<const int> near) {
  const Segment axis = moving.axis(part);
  const double size = radius(moving, part), within = reach(moving, part), length = moving.parts[part].length;
  ++vertex_clock_;
  for (const TouchContact& c : law_.contacts())
    if ((c.is_by(tool, part) || (c.is_by(tool) && c.grasped)) && !c.face)
      vertex_stamp_[c.anchor.nodes[0]] = vertex_clock_;
  for (int t : near)
    for (int node : surface_.triangle(t)) {
      const bool seen = !surface_.touchable(node) || vertex_stamp_[node] == vertex_clock_;
      if (seen || mean_edge_[t] > size || law_.full()) continue;
      vertex_stamp_[node] = vertex_clock_;
      const Eigen::Vector3d& x = surface_.positions()[node];
      const double share = nearest_share(axis, x);
      const Eigen::Vector3d away = axis.at(share) - x;
      if (away.squaredNorm() > within * within) continue;
      const Eigen::Vector3d out = length > 0 ? outward(node) : surface_.vertex_normal(node);
      Eigen::Vector3d normal = length > 0 ? came_from(node, moving.axis_before(part), -out) : Eigen::Vector3d(-out);
      const bool in_front = away.dot(out) > 0 && (length == 0 || away.dot(surface_.outer_side(node)) > 0);
      if (!in_front) {  // behind the surface: pushed through it from the side of the part's other contacts
        const TouchContact* held = held_near(moving, tool, part, share * length, kSideWithin * size);
        if (!held || (length > 0 ? !pushed_through(node, *held, size) : out.dot(held->normal) >= 0)) continue;
        normal = held->normal;
      }
      TouchContact c{.by = ToolPoint{.tool = tool, .part = part, .softness = softness(tool)}};
      c.anchor = {{node, node, node}, Eigen::Vector3d::UnitX()};
      c.normal = normal;
      law_.add(c);
    }
}

// Where triangles are larger than a sphere, it touches between their vertices, at the surface point nearest to its
// centre (TVCG99 sec. 5, sub-triangular precision). One point a sphere: a second one in the same dent would depend on
// the first.
void ToolContacts::add_face(const MovingTool& moving, int tool, int part, std::span<const int> near) {
  const Eigen::Vector3d centre = moving.axis(part).start;
  const double size = radius(moving, part), within = reach(moving, part);
  int face = -1;
  bool vertices_carry = false;
  for (int i = 0; i < static_cast<int>(law_.contacts().size()); ++i) {
    const TouchContact& c = law_.contacts()[i];
    if (!c.is_by(tool, part) || c.grasped) continue;
    if (c.face) face = i;
    vertices_carry |= !c.face && c.touch != Touch::open;
  }
  if (face >= 0 && vertices_carry) law_.remove(face);
  if (vertices_carry) return;
  if (face >= 0) {
    if (law_.contacts()[face].touch != Touch::sticking) follow(face, moving, near);
    return;
  }
  if (law_.full()) return;
  double least = within * within;
  int nearest = -1;
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
  for (int t : near) {
    if (mean_edge_[t] <= size || triangle_taken(tool, surface_.triangle(t), -1)) continue;
    const Triangle corners = surface_.corners(t);
    const ClosestPoint p = closest_point(centre, corners);
    const Eigen::Vector3d at = p.weights[0] * corners[0] + p.weights[1] * corners[1] + p.weights[2] * corners[2];
    if (!is_nearer(p.squared_distance, least) || (centre - at).dot(surface_.triangle_normal(t)) <= 0) continue;
    least = p.squared_distance;
    nearest = t;
    weights = p.weights;
  }
  if (nearest < 0) return;
  TouchContact c{.by = ToolPoint{.tool = tool, .part = part, .softness = face_softness(tool, size)}, .face = true};
  c.anchor = {surface_.triangle(nearest), weights};
  c.normal = -surface_.triangle_normal(nearest).normalized();
  law_.add(c);
}

// A triangle cannot follow several parts of a tool at once: the first to touch it has it.
bool ToolContacts::triangle_taken(int tool, const std::array<int, 3>& nodes, int besides) const {
  for (int i = 0; i < static_cast<int>(law_.contacts().size()); ++i) {
    const TouchContact& c = law_.contacts()[i];
    if (i != besides && c.is_by(tool) && c.face && !c.grasped && c.anchor.nodes == nodes) return true;
  }
  return false;
}

// The anchor comes along with the tool. How far the tool has slipped over it in this step is kept in the offset, and
// how far friction has bent what gives way between the two: slipping does not straighten that.
void ToolContacts::follow(int contact, const MovingTool& moving, std::span<const int> near) {
  const ToolPoint by = law_.contacts()[contact].tool_point();
  const Segment axis = moving.axis(by.part);
  const double length = moving.parts[by.part].length, size = radius(moving, by.part);
  const Eigen::Vector3d slipped = moving.to_world(by.part, by.offset) - moving.to_world_before(by.part, by.offset);
  const double share = length > 0 ? std::clamp(by.offset.z(), 0.0, length) / length : 0.0;
  follow(contact, axis.at(share), near);
  TouchContact& followed = law_.contacts().back();
  const Eigen::Vector3d bent = followed.softness() * followed.force;
  const Eigen::Vector3d on_tool = anchor_position(followed.anchor, surface_.positions()) + bent + slipped;
  const Eigen::Vector3d centre = nearest_point(axis, on_tool);
  followed.tool_point().offset = moving.to_part(by.part, centre + size * (on_tool - centre).normalized());
}

// A sliding contact keeps to the nearest point of its triangle and goes over to a neighbour only across the border
// that it has reached: in the dent that it makes, other triangles may be nearer.
void ToolContacts::follow(int contact, const Eigen::Vector3d& centre, std::span<const int> near) {
  const Anchor& now = law_.contacts()[contact].anchor;
  const auto& x = surface_.positions();
  const ClosestPoint own = closest_point(centre, {x[now.nodes[0]], x[now.nodes[1]], x[now.nodes[2]]});
  Anchor followed{now.nodes, own.weights};
  double least = own.squared_distance;
  for (int t : near) {
    const auto& nodes = surface_.triangle(t);
    bool across = own.weights.minCoeff() <= 0 && nodes != now.nodes;
    for (int v = 0; v < 3; ++v)
      across &= own.weights[v] <= 0 || std::find(nodes.begin(), nodes.end(), now.nodes[v]) != nodes.end();
    if (!across || triangle_taken(law_.contacts()[contact].tool_point().tool, nodes, contact)) continue;
    const ClosestPoint p = closest_point(centre, surface_.corners(t));
    if (!is_nearer(p.squared_distance, least)) continue;
    least = p.squared_distance;
    followed = {nodes, p.weights};
  }
  law_.move_anchor(contact, followed);
}

}  // namespace palpate
