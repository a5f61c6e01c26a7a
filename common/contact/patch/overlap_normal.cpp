#include "common/contact/patch/overlap_normal.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kMinShare = 1e-9;    // of about the whole disc: what is less is rounding
constexpr double kBeyond = 1 + 1e-9;  // squared radii of the disc's middle from an edge: it certainly lies beyond

// Over a triangle from the disc's middle to a piece of a line at distance d, by the tangents of the angles from the
// foot on the line to its ends: the integral of (3 a^4 r^2 - 3 a^2 r^4 + r^6) / 6 over the angle, r = d / cos.
double below_line(double a2, double d, double from, double to) {
  const auto at = [&](double t) {
    const double d2 = d * d, t2 = t * t;
    return d2 * t * (3 * a2 * a2 - 3 * a2 * d2 * (1 + t2 / 3) + d2 * d2 * (1 + t2 * (2.0 / 3 + t2 / 5)));
  };
  return (at(to) - at(from)) / 6;
}

// The same between two directions, where the line is beyond the disc.
double below_arc(double a2, double from, double to) {
  return a2 * a2 * a2 * (std::atan(to) - std::atan(from)) / 6;
}

// Integral of (a^2 - r^2)^2 over the disc's part within the triangle of its middle and an edge, p and q from there;
// negative where they go round it clockwise about `normal`.
double beside_edge(double a2, const Vector3d& p, const Vector3d& q, const Vector3d& normal) {
  const Vector3d along = (q - p).normalized();
  const double d = normal.dot(p.cross(along)), size = std::abs(d);
  if (size < 1e-12 * std::sqrt(a2)) return 0;
  const double from = p.dot(along) / size, to = q.dot(along) / size;
  const double chord = size * size < a2 ? std::sqrt(a2 / (size * size) - 1) : 0;  // tangent where it leaves the disc
  const double begin = std::clamp(from, -chord, chord), end = std::clamp(to, -chord, chord);
  const double sum = below_line(a2, size, begin, end) + below_arc(a2, from, std::min(to, std::max(from, -chord))) +
                     below_arc(a2, std::max(from, std::min(to, chord)), to);
  return std::copysign(sum, d);
}

// Whether the disc lies beyond an edge as a whole, and so beside the triangle. p and q as above.
bool is_beyond(double a2, const Vector3d& p, const Vector3d& q, const Vector3d& normal) {
  const double side = normal.dot(p.cross(q));
  return side < 0 && side * side > kBeyond * a2 * (q - p).squaredNorm();
}

}  // namespace

Vector3d overlap_normal(const SmoothSurface& surface, std::span<const int> triangles, const Vector3d& middle,
                        double radius, const Vector3d& out, double facing) {
  Vector3d sum = Vector3d::Zero();
  for (const int t : triangles) {
    const Vector3d& normal = surface.facet_normal(t);
    const double faces = normal.dot(out) - facing;
    if (faces <= 0 || !surface.may_meet(t, middle, normal, radius)) continue;
    const Triangle corner = surface.corners(t);
    const double high = normal.dot(middle - corner[0]);
    if (high >= radius) continue;
    const double a2 = radius * radius - std::pow(std::max(high, 0.0), 2);
    const Vector3d foot = middle - high * normal;
    const Triangle c{corner[0] - foot, corner[1] - foot, corner[2] - foot};
    if (is_beyond(a2, c[0], c[1], normal) || is_beyond(a2, c[1], c[2], normal) || is_beyond(a2, c[2], c[0], normal))
      continue;
    double share = 0;
    for (int v = 0; v < 3; ++v) share += beside_edge(a2, c[v], c[(v + 1) % 3], normal);
    if (share > kMinShare * a2 * a2 * a2) sum += faces * share * normal;
  }
  return sum;
}

}  // namespace palpate
