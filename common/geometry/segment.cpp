#include "common/geometry/segment.hpp"

#include <cmath>
#include <limits>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kParallel = 1e-12;  // squared sine of the angle between segments, below which they count as parallel
constexpr double kMinAcross =
    0.1;                       // sine between an axis and a side, below which the side says nothing across the axis
constexpr int kHalvings = 10;  // of a segment, in the search for an end of its level part

double distance(const Segment& s, double share, const Triangle& t) {
  return std::sqrt(closest_point(s.at(share), t).squared_distance);
}

/// The sphere about `centre` that leads a point inside or behind it out along `side`.
Touching led_out(const Vector3d& centre, double radius, const Vector3d& point, const Vector3d& side) {
  const Vector3d d = point - centre;
  const Vector3d lateral = d - d.dot(side) * side;
  const double left = radius * radius - lateral.squaredNorm();
  return {centre, left > 0 ? Vector3d((lateral + std::sqrt(left) * side) / radius) : side};
}

/// Where the line from a point along `side` leaves the part, and whether through the sphere at one of its ends.
struct Exit {
  Touching touching;
  bool by_end;
};

Exit leave(const Segment& axis, double radius, const Vector3d& point, const Vector3d& side) {
  const double length = axis.length();
  const Vector3d along = (axis.end - axis.start) / length, from_start = point - axis.start;
  const double place = from_start.dot(along), advance = side.dot(along);
  const Vector3d lateral = from_start - place * along, across = side - advance * along;
  const double square = across.squaredNorm();
  const auto through = [&](const Vector3d& end) { return Exit{led_out(end, radius, point, side), true}; };
  if (square < kParallel) return through(advance > 0 ? axis.end : axis.start);
  const double half = lateral.dot(across), left = half * half - square * (lateral.squaredNorm() - radius * radius);
  const double way = (-half + std::sqrt(std::max(left, 0.0))) / square, at = place + way * advance;
  if (at < 0 || at > length) return through(at < 0 ? axis.start : axis.end);
  const Vector3d centre = axis.start + at * along;
  if (!(left > 0)) return {{centre, side}, false};  // the line passes the part
  return {{centre, (lateral + way * across) / radius}, false};
}

/// Led out at its own place along the axis, across it: towards `side` as far as that looks across, else on the shortest
/// way.
Touching led_out_across(const Segment& axis, double radius, const Vector3d& point, const Vector3d& side) {
  const Vector3d along = (axis.end - axis.start).normalized(), centre = nearest_point(axis, point);
  const Vector3d across = side - side.dot(along) * along, d = point - centre;
  if (across.norm() > kMinAcross) return led_out(centre, radius, point, across.normalized());
  return {centre, d.isZero(0) ? along.unitOrthogonal() : Vector3d(d.normalized())};
}

}  // namespace

ClosestOfSegments closest_points(const Segment& a, const Segment& b) {
  const Vector3d u = a.end - a.start, v = b.end - b.start;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const auto at = [&](double share_a, double share_b) {
    return ClosestOfSegments{share_a, share_b, (a.at(share_a) - b.at(share_b)).squaredNorm()};
  };
  if (uu == 0) return at(0, nearest_share(b, a.start));
  if (vv == 0) return at(nearest_share(a, b.start), 0);
  if (uu * vv - uv * uv <= kParallel * uu * vv) {
    // The middle of what of a lies beside b; apart, two ends are nearest.
    double low = (b.start - a.start).dot(u) / uu, high = (b.end - a.start).dot(u) / uu;
    if (low > high) std::swap(low, high);
    const double share = 0.5 * (std::clamp(low, 0.0, 1.0) + std::clamp(high, 0.0, 1.0));
    return at(share, nearest_share(b, a.at(share)));
  }
  // The lines' nearest points, if both lie on the segments; else an end of one belongs to the nearest pair.
  const Vector3d w = b.start - a.start;
  const double wu = w.dot(u), wv = w.dot(v), det = uu * vv - uv * uv;
  const double share_a = (wu * vv - wv * uv) / det, share_b = (wu * uv - wv * uu) / det;
  if (share_a >= 0 && share_a <= 1 && share_b >= 0 && share_b <= 1) return at(share_a, share_b);
  ClosestOfSegments best{0, 0, std::numeric_limits<double>::infinity()};
  const auto try_pair = [&](const ClosestOfSegments& pair) {
    if (pair.squared_distance < best.squared_distance) best = pair;
  };
  for (const double end : {0.0, 1.0}) {
    try_pair(at(end, nearest_share(b, a.at(end))));
    try_pair(at(nearest_share(a, b.at(end)), end));
  }
  return best;
}

ClosestOfTriangle closest_points(const Segment& segment, const Triangle& triangle) {
  ClosestOfTriangle best{.squared_distance = std::numeric_limits<double>::infinity()};
  const auto try_share = [&](double share) {
    const ClosestPoint p = closest_point(segment.at(share), triangle);
    if (p.squared_distance < best.squared_distance) best = {share, p.weights, p.squared_distance};
  };
  try_share(0);
  if (segment.start == segment.end) return best;
  try_share(1);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const ClosestOfSegments pair = closest_points(segment, Segment{triangle[i], triangle[j]});
    if (pair.squared_distance >= best.squared_distance) continue;
    best = {pair.share_a, Vector3d::Zero(), pair.squared_distance};
    best.weights[i] = 1 - pair.share_b;
    best.weights[j] = pair.share_b;
  }
  const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double above = (segment.start - triangle[0]).dot(normal), below = (segment.end - triangle[0]).dot(normal);
  if (above * below < 0) try_share(above / (above - below));  // it passes the plane
  return best;
}

double level_share(const Segment& segment, const Triangle& triangle, double nearest, double tie) {
  // The distance from a convex set along a line is convex: its level part is one interval.
  const double most = distance(segment, nearest, triangle) + tie;
  const auto end_of_level = [&](double outside) {
    if (distance(segment, outside, triangle) <= most) return outside;
    double inside = nearest;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (inside + outside);
      (distance(segment, middle, triangle) <= most ? inside : outside) = middle;
    }
    return inside;
  };
  return 0.5 * (end_of_level(0) + end_of_level(1));
}

Touching touching(const Segment& axis, double radius, const Vector3d& point, const Vector3d& side, double thrust) {
  const double share = nearest_share(axis, point);
  const Vector3d centre = axis.at(share), d = point - centre;
  const bool ahead = d.dot(side) > 0, within = d.squaredNorm() < radius * radius;
  if (ahead && !within) return {centre, d.normalized()};
  if (axis.start == axis.end) return led_out(centre, radius, point, side);
  const Exit exit = leave(axis, radius, point, side);
  const bool near = (exit.touching.centre - centre).squaredNorm() <= thrust * thrust;
  if (near && (exit.by_end || !ahead)) return exit.touching;
  return led_out_across(axis, radius, point, side);
}

}  // namespace palpate
