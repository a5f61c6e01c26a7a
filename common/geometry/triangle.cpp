#include "common/geometry/triangle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

using Eigen::Vector3d;

/// Sets `best` to the closest point of edge (i, j) if that is closer.
void try_edge(const Vector3d& p, const Triangle& triangle, int i, int j, ClosestPoint& best) {
  const Vector3d edge = triangle[j] - triangle[i];
  const double length = edge.squaredNorm();
  const double along = length > 0 ? std::clamp((p - triangle[i]).dot(edge) / length, 0.0, 1.0) : 0.0;
  const double distance = (triangle[i] + along * edge - p).squaredNorm();
  if (!(distance < best.squared_distance)) return;
  best.squared_distance = distance;
  best.weights.setZero();
  best.weights[i] = 1 - along;
  best.weights[j] = along;
}

/// Coefficients of a cubic in Bernstein form on [0, 1]: its values lie between the least and the largest of
/// them.
using Cubic = std::array<double, 4>;

double value(const Cubic& b, double t) {
  const double s = 1 - t;
  const double b01 = s * b[0] + t * b[1], b12 = s * b[1] + t * b[2], b23 = s * b[2] + t * b[3];
  return s * (s * b01 + t * b12) + t * (s * b12 + t * b23);
}

double slope(const Cubic& b, double t) {
  const double s = 1 - t;
  return 3 * (s * s * (b[1] - b[0]) + 2 * s * t * (b[2] - b[1]) + t * t * (b[3] - b[2]));
}

double max_curvature(const Cubic& b) {
  return 6 * std::max(std::abs(b[2] - 2 * b[1] + b[0]), std::abs(b[3] - 2 * b[2] + b[1]));
}

/// Times in (0, 1), ascending, that cut [0, 1] into parts on which the cubic is monotone. Returns how many.
int turning_points(const Cubic& b, std::array<double, 2>& times) {
  const double c = b[1] - b[0], d = b[2] - b[1], e = b[3] - b[2];
  const double square = c - 2 * d + e, half = d - c, discriminant = half * half - square * c;
  if (!(discriminant > 0)) return 0;
  const double q = -(half + std::copysign(std::sqrt(discriminant), half));
  const double roots[2] = {square != 0 ? q / square : -1, q != 0 ? c / q : -1};
  int count = 0;
  for (const double t : roots)
    if (t > 0 && t < 1) times[count++] = t;
  if (count == 2 && times[0] > times[1]) std::swap(times[0], times[1]);
  return count;
}

bool outside(double volume) {
  return volume >= 0;
}

/// The time at which the monotone cubic changes side between low and high: Newton steps, halving where they
/// leave the bracket or converge slowly.
double side_change(const Cubic& b, double low, double high) {
  const bool start = outside(value(b, low));
  double t = 0.5 * (low + high);
  for (int i = 0; i < 200 && high - low > 1e-16; ++i) {
    const double v = value(b, t);
    (outside(v) == start ? low : high) = t;
    double next = t - v / slope(b, t);
    if (!(next >= low && next <= high) || i % 4 == 3) next = 0.5 * (low + high);
    if (std::abs(next - t) <= 1e-16) return next;
    t = next;
  }
  return t;
}

/// The corners as the moving point sees them.
struct Relative {
  Relative(const Vector3d& p0, const Vector3d& p1, const Triangle& triangle0, const Triangle& triangle1) {
    for (int v = 0; v < 3; ++v) {
      at0[v] = triangle0[v] - p0;
      at1[v] = triangle1[v] - p1;
      reach = std::max({reach, at0[v].cwiseAbs().maxCoeff(), at1[v].cwiseAbs().maxCoeff()});
      speed = std::max(speed, (at1[v] - at0[v]).cwiseAbs().maxCoeff());
    }
  }

  /// False if the boxes of point and triangle, swept and grown by the margin, do not meet.
  bool near(double margin) const {
    for (int axis = 0; axis < 3; ++axis) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (int v = 0; v < 3; ++v) {
        low = std::min({low, at0[v][axis], at1[v][axis]});
        high = std::max({high, at0[v][axis], at1[v][axis]});
      }
      if (low > margin || high < -margin) return false;
    }
    return true;
  }

  /// Six times the volume of the tetrahedron of point and triangle over time, positive outside; linear in
  /// time if the triangle keeps still.
  Cubic volume(bool still) const {
    const auto det = [](const Vector3d& a, const Vector3d& b, const Vector3d& c) { return -a.dot(b.cross(c)); };
    const auto &a = at0, &b = at1;
    if (still) {
      const double begin = det(a[0], a[1], a[2]), end = det(b[0], b[1], b[2]);
      return {begin, (2 * begin + end) / 3, (begin + 2 * end) / 3, end};
    }
    return {det(a[0], a[1], a[2]), (det(b[0], a[1], a[2]) + det(a[0], b[1], a[2]) + det(a[0], a[1], b[2])) / 3,
            (det(a[0], b[1], b[2]) + det(b[0], a[1], b[2]) + det(b[0], b[1], a[2])) / 3, det(b[0], b[1], b[2])};
  }

  Triangle at(double t) const {
    Triangle corners;
    for (int v = 0; v < 3; ++v) corners[v] = (1 - t) * at0[v] + t * at1[v];
    return corners;
  }

  Triangle at0, at1;
  double reach = 0;  ///< [m] largest coordinate
  double speed = 0;  ///< [m] per step, largest coordinate
};

constexpr double kTolerance = 1e-9;     ///< of the reach: how far beside the triangle a crossing still counts
constexpr double kVolumeError = 4e-15;  ///< of the reach cubed: bound of the error of a computed volume
constexpr double kMaxShare = 1e-4;      ///< of the reach: no tolerance is larger

double lateral_tolerance(const Relative& relative, const Cubic& volume, double t) {
  const double error = kVolumeError * relative.reach * relative.reach * relative.reach;
  const double late = std::min(error / std::abs(slope(volume, t)), std::sqrt(2 * error / max_curvature(volume)));
  const double sideways = std::isfinite(late) ? late * relative.speed : 0.0;
  return std::min(kTolerance * relative.reach + sideways, kMaxShare * relative.reach);
}

std::optional<SweptHit> crossing_at(const Relative& relative, const Cubic& volume, double t, bool from_outside) {
  const ClosestPoint closest = closest_point(Vector3d::Zero(), relative.at(t));
  const double tolerance = lateral_tolerance(relative, volume, t);
  if (!(closest.squared_distance <= tolerance * tolerance)) return std::nullopt;
  return SweptHit{t, closest.weights, from_outside};
}

}  // namespace

ClosestPoint closest_point(const Vector3d& p, const Triangle& triangle) {
  ClosestPoint best{Vector3d::UnitX(), std::numeric_limits<double>::infinity()};
  try_edge(p, triangle, 0, 1, best);
  try_edge(p, triangle, 1, 2, best);
  try_edge(p, triangle, 2, 0, best);
  const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double square = normal.squaredNorm();
  if (!(square > 0)) return best;
  Vector3d weights;
  for (int v = 0; v < 3; ++v) {
    const Vector3d &next = triangle[(v + 1) % 3], &last = triangle[(v + 2) % 3];
    weights[v] = (next - p).cross(last - p).dot(normal) / square;
  }
  if (!(weights.minCoeff() > 0)) return best;
  weights /= weights.sum();
  const double distance =
      (weights[0] * triangle[0] + weights[1] * triangle[1] + weights[2] * triangle[2] - p).squaredNorm();
  if (distance < best.squared_distance) best = {weights, distance};
  return best;
}

std::optional<SweptHit> sweep_point(const Vector3d& p0, const Vector3d& p1, const Triangle& triangle0,
                                    const Triangle& triangle1) {
  const Relative relative(p0, p1, triangle0, triangle1);
  if (!relative.near(kMaxShare * relative.reach)) return std::nullopt;
  const bool still = triangle0 == triangle1;
  const Cubic volume = relative.volume(still);
  const auto [least, largest] = std::minmax_element(volume.begin(), volume.end());
  if (outside(*least) == outside(*largest)) return std::nullopt;
  if (still) return crossing_at(relative, volume, volume[0] / (volume[0] - volume[3]), outside(volume[0]));
  std::array<double, 2> turns;
  const int count = turning_points(volume, turns);
  double begin = 0;
  for (int i = 0; i <= count; ++i) {
    const double end = i < count ? turns[i] : 1.0;
    const bool before = outside(value(volume, begin));
    if (before != outside(value(volume, end))) {
      const auto hit = crossing_at(relative, volume, side_change(volume, begin, end), before);
      if (hit) return hit;
    }
    begin = end;
  }
  return std::nullopt;
}

}  // namespace palpate
