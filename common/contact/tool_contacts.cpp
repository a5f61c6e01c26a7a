#include "common/contact/tool_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/tool/instrument.hpp"

namespace palpate {
namespace {

constexpr double kMinFacing =
    0.1;  // cosine between a sticking contact's normal and the surface's, below which it slides
constexpr double kMarginShare =
    0.1;  // of a part's radius or a mean edge: what is this near is watched before it is touched

// [m] at rest, from corner v to the next.
double edge_of(const ContactSurface& surface, int triangle, int v) {
  const auto& t = surface.triangle(triangle);
  return (surface.rest()[t[v]] - surface.rest()[t[(v + 1) % 3]]).norm();
}

MovingTool standing(MovingTool tool) {
  tool.before = tool.now;
  tool.parts_before = tool.parts;
  return tool;
}

}  // namespace

std::size_t parts_of(std::span<const Tool> tools) {
  std::size_t parts = 0;
  for (const Tool& t : tools) parts += tool_parts(t).size();
  return parts;
}

double mean_edge(const SurfaceMap& map) {
  double sum = 0;
  for (const auto& t : map.triangles)
    for (int v = 0; v < 3; ++v) sum += (map.position[t[v]] - map.position[t[(v + 1) % 3]]).norm();
  return sum / (3.0 * map.triangles.size());
}

double bucket_size(const ContactSpec& contact, const SurfaceMap& map) {
  return contact.bucket_size > 0 ? contact.bucket_size : 2 * mean_edge(map);
}

ToolContacts::ToolContacts(const ContactSurface& surface, ContactLaw& law, std::size_t parts, Options options)
    : law_(law), surface_(surface), options_(std::move(options)), vertex_stamp_(surface.nodes(), 0) {
  double sum = 0;
  for (int t = 0; t < surface.triangle_count(); ++t) {
    double edges = 0;
    for (int v = 0; v < 3; ++v) {
      edges += edge_of(surface, t, v);
      sum += edge_of(surface, t, v);
    }
    mean_edge_.push_back(edges / 3);
  }
  body_edge_ = sum / (3.0 * surface.triangle_count());
  near_.reserve(parts * surface.triangle_count());
  near_end_.reserve(parts);
  if (options_.elsewhere) own_near_.reserve(surface.triangle_count());
  candidates_.reserve(surface.triangle_count());
  crossings_.resize(kMaxSwept + 1);
}

double ToolContacts::margin(double radius) const {
  return kMarginShare * std::min(radius, body_edge_);
}

double ToolContacts::reach(const MovingTool& moving, int part) const {
  const Segment before = moving.axis_before(part), now = moving.axis(part);
  const double motion =
      std::sqrt(std::max((now.start - before.start).squaredNorm(), (now.end - before.end).squaredNorm()));
  return radius(moving, part) + margin(radius(moving, part)) + motion;
}

// Into the tissue, by the deformed surface's own normal at the anchor: the side from which a tool may touch it.
Eigen::Vector3d ToolContacts::inward(const TouchContact& c, bool segment) const {
  if (segment) return c.face ? -outward(c.anchor.nodes) : -outward(c.anchor.nodes[0]);
  if (!c.face) return -surface_.vertex_normal(c.anchor.nodes[0]);
  const auto& x = surface_.positions();
  const auto& n = c.anchor.nodes;
  return -(x[n[1]] - x[n[0]]).cross(x[n[2]] - x[n[0]]).normalized();
}

// How far from an end of a part what has just come within it may have entered through that end.
double ToolContacts::thrust(const MovingTool& moving, int part) const {
  const Segment before = moving.axis_before(part), now = moving.axis(part);
  const double length = moving.parts[part].length;
  return length > 0 ? 2 * radius(moving, part) + std::abs((now.start - before.start).dot(now.end - now.start)) / length
                    : 0.0;
}

Touching ToolContacts::touch_of(const TouchContact& c, const MovingTool& moving, const Segment& axis,
                                const Eigen::Vector3d& into) const {
  const Eigen::Vector3d anchor = anchor_position(c.anchor, surface_.positions());
  const int part = c.tool_point().part;
  const double size = radius(moving, part), most = thrust(moving, part);
  Touching touch = touching(axis, size, anchor, into, most);
  // A corner has no plane of its own: while it is ahead, it is met on the shortest way.
  const Eigen::Vector3d d = anchor - touch.centre;
  if (!c.face && d.dot(into) > 0 && touch.centre == nearest_point(axis, anchor)) touch.normal = d.normalized();
  // A segment that has passed over the anchor within this step, across the surface's own direction, does not come round
  // it.
  const bool passed = moving.parts[part].length > 0 && touch.normal.dot(c.normal) < 0;
  return passed ? touching(axis, size, anchor, c.normal, most) : touch;
}

void ToolContacts::aim(TouchContact& c, const MovingTool& moving) const {
  const ToolPoint& by = c.tool_point();
  if (c.grasped) {
    c.at = c.target = moving.now * by.offset;
    return;
  }
  const Segment axis = moving.axis(by.part);
  const Eigen::Vector3d into = inward(c, moving.parts[by.part].length > 0);
  const double size = radius(moving, by.part);
  c.target = moving.to_world(by.part, by.offset);
  Touching touch{nearest_point(axis, c.target), Eigen::Vector3d::Zero()};
  touch.normal = (c.target - touch.centre).normalized();
  if (c.touch != Touch::sticking || touch.normal.dot(into) <= kMinFacing) {
    if (c.touch == Touch::sticking) c.touch = Touch::sliding;  // the tool has turned away from its anchor
    touch = touch_of(c, moving, axis, into);
    if (c.touch == Touch::open) c.target = touch.centre + size * touch.normal;
  }
  c.normal = touch.normal;
  c.plane = c.normal.dot(touch.centre) + size;
  c.at = touch.centre + size * c.normal;
}

void ToolContacts::aim(std::span<const MovingTool> tools) {
  for (TouchContact& c : law_.contacts()) aim(c, tools[c.tool_point().tool]);
}

void ToolContacts::slide(TouchContact& c, const MovingTool& moving) const {
  if (c.grasped || c.touch == Touch::open) return;
  ToolPoint& by = c.tool_point();
  Eigen::Vector3d touched = c.target;
  if (c.touch == Touch::sliding) {
    const Eigen::Vector3d held = c.held_at(), centre = nearest_point(moving.axis(by.part), held);
    touched = centre + radius(moving, by.part) * (held - centre).normalized();
  }
  by.offset = moving.to_part(by.part, touched);
}

// Within its own triangle: the search for others comes with the next step of the surface.
void ToolContacts::slide(std::span<const MovingTool> tools) {
  for (TouchContact& c : law_.contacts()) slide(c, tools[c.tool_point().tool]);
  int at = 0;
  for (int left = static_cast<int>(law_.contacts().size()); left > 0; --left) {
    const TouchContact& c = law_.contacts()[at];
    if (!c.face || c.grasped || c.touch == Touch::sticking)
      ++at;
    else
      follow(at, standing(tools[c.tool_point().tool]), {});
  }
}

void ToolContacts::settle(std::span<const MovingTool> tools) {
  for (int i = static_cast<int>(law_.contacts().size()) - 1; i >= 0; --i) {
    TouchContact& c = law_.contacts()[i];
    if (c.grasped) continue;
    const int part = c.tool_point().part;
    const MovingTool& moving = tools[c.tool_point().tool];
    if (c.touch == Touch::open) {
      const Eigen::Vector3d anchor = anchor_position(c.anchor, surface_.positions());
      const bool gone = (anchor - nearest_point(moving.axis(part), anchor)).norm() >
                        reach(moving, part) + margin(radius(moving, part));
      if (c.face || gone) law_.remove(i);
    } else if (moving.parts[part].length > 0 && inside_out(c)) {
      law_.remove(i);
    } else {
      slide(c, moving);
    }
  }
}

void ToolContacts::adopt(TouchContact contact) {
  contact.tool_point().softness = softness(contact.tool_point().tool);
  law_.add(contact);
}

bool ToolContacts::take_in_jaws(int tool, const Eigen::Isometry3d& pose, const Anchor& anchor, bool face) {
  if (law_.full()) return false;
  TouchContact c{.by = ToolPoint{.tool = tool, .softness = softness(tool)}, .face = face, .grasped = true};
  c.touch = Touch::sticking;
  c.anchor = anchor;
  c.tool_point().offset = pose.inverse() * anchor_position(anchor, surface_.positions());
  c.normal = pose.linear().col(2);
  law_.add(c);
  return true;
}

// The surface point nearest to the jaws' middle, where triangles are larger than they are.
bool ToolContacts::grasp_nearest(int tool, const Eigen::Isometry3d& pose, double length) {
  const Eigen::Vector3d middle = pose * Eigen::Vector3d(0, 0, 0.5 * length);
  double least = 0.25 * length * length;
  std::optional<Anchor> nearest;
  for (int t : surface_.find(middle, middle, length)) {
    const ClosestPoint p = closest_point(middle, surface_.corners(t));
    if (!is_nearer(p.squared_distance, least)) continue;
    least = p.squared_distance;
    nearest = {surface_.triangle(t), p.weights};
  }
  if (nearest) take_in_jaws(tool, pose, *nearest, true);
  return nearest.has_value();
}

void ToolContacts::let_go(int tool) {
  for (int i = static_cast<int>(law_.contacts().size()) - 1; i >= 0; --i)
    if (law_.contacts()[i].grasped && law_.contacts()[i].is_by(tool)) law_.remove(i);
}

}  // namespace palpate
