// What ToolContacts does for parts that are segments and not spheres.
#include <algorithm>
#include <cmath>

#include "common/contact/tool_contacts.hpp"

namespace palpate {
namespace {

constexpr double kMinAgreement =
    0.2;  // cosine between a normal now and at rest, below which the surface counts as folded
constexpr double kMaxInsideOut =
    0.1;  // cosine between a contact's normal and the wall's outer side at rest, above which it is given up
constexpr double kSameWall =
    0.5;  // cosine between normals at rest, below which two nodes are of different sides of a tube
constexpr double kApartShare =
    1.0 / 3;  // of a triangle's mean edge: contacts of one segment nearer than that depend on one another

Eigen::Vector3d unless_folded(const Eigen::Vector3d& now, const Eigen::Vector3d& rest) {
  return now.dot(rest) > kMinAgreement ? now : rest;
}

/// Which of the points 0 ... last, spread evenly along a segment, lie within a box grown by `motion` [m]: from ... to.
std::array<int, 2> points_in(const std::array<Eigen::Vector3d, 2>& box, const Segment& axis, double motion, int last) {
  double low = 0, high = 1;
  for (int i = 0; i < 3; ++i) {
    const double along = axis.end[i] - axis.start[i];
    const double first = box[0][i] - motion - axis.start[i], end = box[1][i] + motion - axis.start[i];
    if (along == 0) {
      if (first > 0 || end < 0) return {1, 0};
      continue;
    }
    low = std::max(low, std::min(first / along, end / along));
    high = std::min(high, std::max(first / along, end / along));
  }
  if (low > high) return {1, 0};
  return {std::max(0, static_cast<int>(std::floor(low * last))),
          std::min(last, static_cast<int>(std::ceil(high * last)))};
}

}  // namespace

// Where a thin wall is thrust in deeply, linear displacements fold it over itself and its normals lose their meaning:
// which side is the outer one is known from the wall at rest.
Eigen::Vector3d ToolContacts::outward(int node) const {
  return unless_folded(surface_.vertex_normal(node), surface_.outer_side(node));
}

Eigen::Vector3d ToolContacts::outward(const std::array<int, 3>& n) const {
  const auto& x = surface_.positions();
  return unless_folded((x[n[1]] - x[n[0]]).cross(x[n[2]] - x[n[0]]).normalized(), surface_.outer_side(n));
}

Eigen::Vector3d ToolContacts::rest_outward(const TouchContact& c) const {
  return c.face ? surface_.outer_side(c.anchor.nodes) : surface_.outer_side(c.anchor.nodes[0]);
}

// What has slid round a part until it would be pushed outward is above it, not under it: a fold, which it does not
// press.
bool ToolContacts::inside_out(const TouchContact& c) const {
  return c.normal.dot(rest_outward(c)) > kMaxInsideOut;
}

// The direction from a segment to a node one step ago: the side from which the segment comes. If it was not in front
// then, `into`.
Eigen::Vector3d ToolContacts::came_from(int node, const Segment& before, const Eigen::Vector3d& into) const {
  const Eigen::Vector3d& x = surface_.previous()[node];
  const Eigen::Vector3d d = x - nearest_point(before, x);
  return d.dot(into) > 0 ? Eigen::Vector3d(d.normalized()) : into;
}

// Whether a node behind the surface has been pushed there together with another contact, `by`, of the same part: it is
// one of its neighbours on the same wall, and not of a tube's other side.
bool ToolContacts::pushed_through(int node, const TouchContact& by, double size) const {
  const Eigen::Vector3d anchor = anchor_position(by.anchor, surface_.rest());
  const double within = 2 * (size + body_edge_);
  return by.normal.dot(outward(node)) < 0 && rest_outward(by).dot(surface_.outer_side(node)) > kSameWall &&
         (surface_.rest()[node] - anchor).squaredNorm() < within * within;
}

// The points of the axis that are swept lie no farther apart than the radius (up to kMaxSwept of them). What passes
// between two of them unseen is narrower than that, and lies within the radius of both as it passes: the search among
// what is near meets it.
bool ToolContacts::add_crossings(const MovingTool& moving, int tool, int part) {
  const Segment before = moving.axis_before(part), now = moving.axis(part);
  const std::span<const int> found = surface_.find(before, now, 0);
  if (found.empty()) return false;
  const double length = moving.parts[part].length;
  const int last = std::min(kMaxSwept, static_cast<int>(std::ceil(length / moving.radius(part))));
  std::fill_n(crossings_.begin(), last + 1, Crossing{});
  const double motion =
      std::sqrt(std::max((now.start - before.start).squaredNorm(), (now.end - before.end).squaredNorm()));
  for (int t : found) {
    if (is_left_out(tool, part, t)) continue;
    if (surface_.triangle_normal(t).dot(surface_.outer_side(surface_.triangle(t))) <= 0) continue;  // folded over
    const auto [from, to] = points_in(surface_.swept_box(t), now, motion, last);
    for (int i = from; i <= to; ++i) {
      const double share = static_cast<double>(i) / last;
      crossings_[i].meet(
          t, sweep_point(before.at(share), now.at(share), surface_.previous_corners(t), surface_.corners(t)));
    }
  }
  bool crossed = false;
  for (int i = 0; i <= last; ++i) {
    const Crossing& crossing = crossings_[i];
    const double place = length * i / last;
    if (crossing.triangle < 0 || triangle_taken(tool, surface_.triangle(crossing.triangle), -1)) continue;
    const Eigen::Vector3d into = -surface_.triangle_normal(crossing.triangle);
    const double within = std::max(radius(moving, part), mean_edge_[crossing.triangle]);
    if (place_taken(moving, tool, part, {place, into, within})) continue;
    crossed |= add_at(crossing, moving, tool, part, place);
  }
  return crossed;
}

// Whether a contact of the part holds a place along its axis already: there is a point on a face, or a vertex that
// carries force, on the same side of the part. In a narrow cut tissue lies on both; a wall that is thrust through
// itself does too, but is met on its outer side alone.
bool ToolContacts::place_taken(const MovingTool& moving, int tool, int part, const Place& place) const {
  const bool wall = options_.offset > 0;
  return std::any_of(law_.contacts().begin(), law_.contacts().end(), [&](const TouchContact& c) {
    if (!c.is_by(tool, part) || c.grasped || (!c.face && c.touch == Touch::open)) return false;
    const double along = std::clamp(c.tool_point().offset.z(), 0.0, moving.parts[part].length);
    const bool same_side = wall || c.normal.dot(place.into) > 0;
    return std::abs(along - place.along) < place.within && same_side;
  });
}

// Where triangles are larger than the segment's radius, it touches each of them at most once.
void ToolContacts::add_faces(const MovingTool& moving, int tool, int part, std::span<const int> near) {
  keep_faces(moving, tool, part, near);
  find_faces(moving, tool, part, near);
  const Segment axis = moving.axis(part);
  const double size = radius(moving, part), length = moving.parts[part].length;
  for (const Candidate& candidate : candidates_) {
    if (law_.full()) return;
    const Triangle corners = surface_.corners(candidate.triangle);
    const bool touches = candidate.squared_distance < size * size;  // what is only near stays open, wherever it is
    const double share = touches ? level_share(axis, corners, candidate.share, margin(size)) : candidate.share;
    const Eigen::Vector3d into = -outward(surface_.triangle(candidate.triangle));
    const double within = std::max(size, kApartShare * mean_edge_[candidate.triangle]);
    if (place_taken(moving, tool, part, {share * length, into, within})) continue;
    TouchContact c{.by = ToolPoint{.tool = tool, .part = part, .softness = face_softness(tool, size)}, .face = true};
    c.anchor = {surface_.triangle(candidate.triangle), closest_point(axis.at(share), corners).weights};
    c.tool_point().offset = {0, 0, share * length};
    c.normal = into;
    law_.add(c);
  }
}

// Points on faces that slide follow the place of the axis that they belong to; where vertices have come to carry, they
// go.
void ToolContacts::keep_faces(const MovingTool& moving, int tool, int part, std::span<const int> near) {
  const double size = radius(moving, part), length = moving.parts[part].length;
  const auto vertex_carries = [&](double place) {
    return std::any_of(law_.contacts().begin(), law_.contacts().end(), [&](const TouchContact& c) {
      const bool carries = c.is_by(tool, part) && !c.grasped && !c.face && c.touch != Touch::open;
      return carries && std::abs(std::clamp(c.tool_point().offset.z(), 0.0, length) - place) < size;
    });
  };
  // One that moves goes to the end of the list: the next one takes its place.
  int at = 0;
  for (int left = static_cast<int>(law_.contacts().size()); left > 0; --left) {
    const TouchContact& c = law_.contacts()[at];
    const bool own = c.is_by(tool, part) && c.face && !c.grasped;
    const double place = std::clamp(c.tool_point().offset.z(), 0.0, length);
    if (own && vertex_carries(place)) {
      law_.remove(at);
    } else if (own && c.touch != Touch::sticking) {
      follow(at, moving, near);
    } else {
      ++at;
    }
  }
}

// The triangles ahead of the segment that it may touch, the nearest first.
void ToolContacts::find_faces(const MovingTool& moving, int tool, int part, std::span<const int> near) {
  const Segment axis = moving.axis(part);
  const double size = radius(moving, part), within = reach(moving, part);
  candidates_.clear();
  for (int t : near) {
    if (mean_edge_[t] <= size) continue;
    const Triangle corners = surface_.corners(t);
    const Eigen::Vector3d normal = surface_.triangle_normal(t).normalized();
    const double start = (axis.start - corners[0]).dot(normal), end = (axis.end - corners[0]).dot(normal);
    if ((start <= 0 && end <= 0) || std::min(start, end) > within)
      continue;  // all of it behind the plane, or far before it
    const Eigen::Vector3d middle = (corners[0] + corners[1] + corners[2]) / 3;
    const double span = std::sqrt(std::max({(corners[0] - middle).squaredNorm(), (corners[1] - middle).squaredNorm(),
                                            (corners[2] - middle).squaredNorm()}));
    const double farthest = within + span;
    if ((nearest_point(axis, middle) - middle).squaredNorm() > farthest * farthest ||
        triangle_taken(tool, surface_.triangle(t), -1))
      continue;
    const ClosestOfTriangle p = closest_points(axis, corners);
    const Eigen::Vector3d at = p.weights[0] * corners[0] + p.weights[1] * corners[1] + p.weights[2] * corners[2];
    if (p.squared_distance >= within * within) continue;
    const auto& nodes = surface_.triangle(t);
    const Eigen::Vector3d away = axis.at(p.share) - at;
    if (away.dot(outward(nodes)) <= 0 || away.dot(surface_.outer_side(nodes)) <= 0) continue;
    const auto farther = std::ranges::find_if(
        candidates_, [&](const Candidate& c) { return is_nearer(p.squared_distance, c.squared_distance); });
    candidates_.insert(farther, {t, p.share, p.squared_distance});
  }
}

}  // namespace palpate
