#include "common/geometry/piece_within.hpp"

#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector2d;

/// About the square's middle. Of a triangle a cut leaves a corner more; of one without width, by rounding, half as many
/// again: 4, 6, 9, 13.
struct Polygon {
  std::array<Vector2d, 13> corner;
  int corners = 0;

  void add(const Vector2d& p) { corner[corners++] = p; }
};

// What of it lies where `sign` times the coordinate is `half` at most.
Polygon cut(const Polygon& whole, int axis, double sign, double half) {
  Polygon left;
  for (int i = 0; i < whole.corners; ++i) {
    const Vector2d &p = whole.corner[i], &q = whole.corner[(i + 1) % whole.corners];
    const double in_p = half - sign * p[axis], in_q = half - sign * q[axis];
    if (in_p >= 0) left.add(p);
    if ((in_p < 0) != (in_q < 0)) left.add(p + in_p / (in_p - in_q) * (q - p));
  }
  return left;
}

}  // namespace

PlanePiece piece_within(const std::array<Vector2d, 3>& triangle, const Vector2d& middle, double half) {
  Polygon polygon;
  for (const Vector2d& corner : triangle) polygon.add(corner - middle);
  for (const int axis : {0, 1})
    for (const double sign : {1.0, -1.0}) polygon = cut(polygon, axis, sign, half);
  double doubled = 0;
  Vector2d sixfold = Vector2d::Zero();
  for (int i = 1; i + 1 < polygon.corners; ++i) {
    const Vector2d &a = polygon.corner[0], &b = polygon.corner[i], &c = polygon.corner[i + 1];
    const Vector2d ab = b - a, ac = c - a;
    const double part = ab.x() * ac.y() - ab.y() * ac.x();
    doubled += part;
    sixfold += part * (a + b + c);
  }
  const double area = 0.5 * std::abs(doubled);
  return {area, area * middle + std::copysign(1.0, doubled) / 6 * sixfold};
}

}  // namespace palpate
