// A point swept against a whole deforming surface: against brute force, through its edges and vertices, and
// by counting how often it goes in and out.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "common/geometry/buckets.hpp"
#include "tests/contact/moving_surface.hpp"
#include "tests/sanitized.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::kSanitized;

struct Found {
  double time = std::numeric_limits<double>::infinity();
  int triangle = -1;
  bool from_outside = false;
};

Found with_buckets(const MovingSurface& surface, const Buckets& buckets, std::vector<int>& room, const Vector3d& p0,
                   const Vector3d& p1) {
  Found first;
  const int count = buckets.query(p0.cwiseMin(p1), p0.cwiseMax(p1), 0, room);
  for (int i = 0; i < count; ++i) {
    const auto hit = sweep_point(p0, p1, surface.before(room[i]), surface.after(room[i]));
    if (hit && hit->time < first.time) first = {hit->time, room[i], hit->from_outside};
  }
  return first;
}

/// A triangle's corners from a point, both on their ways.
template <class Scalar>
struct Ways {
  using Vector = Eigen::Matrix<Scalar, 3, 1>;
  Ways(const Vector3d& p0, const Vector3d& p1, const Triangle& a, const Triangle& b) {
    for (int v = 0; v < 3; ++v) {
      from[v] = a[v].cast<Scalar>() - p0.cast<Scalar>();
      change[v] = b[v].cast<Scalar>() - p1.cast<Scalar>() - from[v];
    }
  }
  Vector corner(int v, Scalar t) const { return from[v] + t * change[v]; }
  Vector normal(Scalar t) const {
    const Vector u = corner(0, t);
    return (corner(1, t) - u).cross(corner(2, t) - u);
  }
  bool outside(Scalar t) const { return -corner(0, t).dot(normal(t)) >= 0; }  ///< of the triangle's plane
  bool above(Scalar t) const {                                                ///< the triangle
    const Vector u = corner(0, t), v = corner(1, t), w = corner(2, t), n = normal(t);
    return v.cross(w).dot(n) >= 0 && w.cross(u).dot(n) >= 0 && u.cross(v).dot(n) >= 0;
  }
  Vector from[3], change[3];
};

/// On which side of the triangle's plane the point is: by a cubic of the time.
class Side {
 public:
  explicit Side(const Ways<double>& ways) {
    const Vector3d u[] = {ways.from[0], ways.change[0]};
    const Vector3d v[] = {ways.from[1] - u[0], ways.change[1] - u[1]},
                   w[] = {ways.from[2] - u[0], ways.change[2] - u[1]};
    for (int i = 0; i < 8; ++i)
      of_power_[(i & 1) + (i >> 1 & 1) + (i >> 2)] -= u[i & 1].dot(v[i >> 1 & 1].cross(w[i >> 2]));
  }
  bool outside(double t) const {
    return of_power_[0] + t * (of_power_[1] + t * (of_power_[2] + t * of_power_[3])) >= 0;
  }

 private:
  double of_power_[4] = {};
};

struct Interval {
  double from, until;  ///< [1] of the path
};

/// The path cut into many short parts, halving where the side changes, in higher precision. What would come before or
/// after `when` is not looked for.
Found by_force(const Vector3d& p0, const Vector3d& p1, const Triangle& a, const Triangle& b, int parts,
               const Interval& when = {0, 1}) {
  const Side side(Ways<double>(p0, p1, a, b));
  const int first = static_cast<int>(when.from * parts);
  bool start = side.outside(static_cast<double>(first) / parts);
  for (int part = first; part < parts && part <= when.until * parts; ++part) {
    const double end = (part + 1.0) / parts;
    const bool before = std::exchange(start, side.outside(end));
    if (before == start) continue;
    const Ways<long double> exact(p0, p1, a, b);
    long double low = static_cast<double>(part) / parts, high = end;
    for (int i = 0; i < 64; ++i) {
      const long double middle = (low + high) / 2;
      (exact.outside(middle) == before ? low : high) = middle;
    }
    if (exact.above(low)) return {static_cast<double>(low), 0, before};
  }
  return {};
}

/// When the path is in a box; from > until where it never is.
Interval within(const std::array<Vector3d, 2>& box, const Vector3d& p0, const Vector3d& p1) {
  constexpr double room = 1e-6;  // for rounding
  Interval in{0, 1};
  for (int axis = 0; axis < 3; ++axis) {
    const double way = p1[axis] - p0[axis];
    const auto [enters, leaves] = std::minmax({(box[0][axis] - p0[axis]) / way, (box[1][axis] - p0[axis]) / way});
    in.from = std::max(in.from, enters - room);
    in.until = std::min(in.until, leaves + room);
  }
  return in;
}

/// The same for all triangles, in their boxes, that the path meets.
Found by_force(const MovingSurface& surface, std::span<const std::array<Vector3d, 2>> boxes, const Vector3d& p0,
               const Vector3d& p1) {
  Found first;
  for (int t = 0; t < surface.size(); ++t) {
    Interval when = within(boxes[t], p0, p1);
    when.until = std::min(when.until, first.time);
    if (when.from > when.until) continue;
    const Found found = by_force(p0, p1, surface.before(t), surface.after(t), 24, when);
    if (found.time < first.time) first = {found.time, t, found.from_outside};
  }
  return first;
}

/// A path that starts anywhere in or around the surface; its length runs from a micrometre to ten metres.
std::array<Vector3d, 2> random_path(MovingSurface& surface) {
  const Vector3d p0 = surface.uniform(0, 0.1) * surface.direction();
  return {p0, p0 + std::pow(10.0, surface.uniform(-6, 1)) * surface.direction()};
}

TEST(Sweep, AgreesWithBruteForceOverAHundredThousandSweepsOfADeformingSurface) {
  MovingSurface surface(21);
  Buckets buckets(surface.rest, surface.triangles, 0.01);
  std::vector<int> room(surface.size());
  std::vector<std::array<Vector3d, 2>> boxes(surface.size());
  constexpr int kRounds = kSanitized ? 10 : 100;
  int hits = 0, sweeps = 0;
  for (int round = 0; round < kRounds; ++round) {
    surface.step(round % 3 ? 0.002 : 0);
    for (int t = 0; t < surface.size(); ++t) {
      boxes[t] = swept_box(surface.before(t), surface.after(t));
      buckets.move(t, boxes[t][0], boxes[t][1]);
    }
    for (int trial = 0; trial < 1000; ++trial, ++sweeps) {
      const auto [p0, p1] = random_path(surface);
      const Found expected = by_force(surface, boxes, p0, p1), found = with_buckets(surface, buckets, room, p0, p1);
      ASSERT_EQ(found.triangle, expected.triangle) << "sweep " << sweeps;
      if (expected.triangle < 0) continue;
      ASSERT_NEAR(found.time, expected.time, 1e-10);
      ASSERT_EQ(found.from_outside, expected.from_outside);
      ++hits;
    }
  }
  EXPECT_EQ(sweeps, 1000 * kRounds);
  EXPECT_GT(hits, 200 * kRounds);
}

TEST(Sweep, AgreesWithBruteForceForTrianglesThatTurnOverWithinAStep) {
  MovingSurface source(26);
  int hits = 0, late = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Triangle a, b;
    for (int v = 0; v < 3; ++v) a[v] = source.direction(), b[v] = source.direction();
    const Vector3d p0 = 0.6 * source.direction(), p1 = 0.6 * source.direction();
    const auto hit = sweep_point(p0, p1, a, b);
    Found expected = by_force(p0, p1, a, b, 128);
    if (hit.has_value() != (expected.triangle == 0)) expected = by_force(p0, p1, a, b, 1 << 18);  // twice in one part
    ASSERT_EQ(hit.has_value(), expected.triangle == 0) << "trial " << trial;
    if (!hit) continue;
    ASSERT_NEAR(hit->time, expected.time, 1e-9) << "trial " << trial;
    ASSERT_EQ(hit->from_outside, expected.from_outside);
    ++hits;
    late += hit->from_outside != Ways<double>(p0, p1, a, b).outside(0);
  }
  EXPECT_GT(hits, 2000);
  EXPECT_GT(late, 20) << "crossings of the plane beside the triangle came first";
}

TEST(Sweep, GoesInAndOutAsOftenAsTheWindingNumberSays) {
  MovingSurface surface(22, 0.001);
  for (int trial = 0; trial < 4000; ++trial) {
    if (trial % 50 == 0) surface.step(0.001);
    const auto [p0, p1] = random_path(surface);
    int net = 0;
    for (int t = 0; t < surface.size(); ++t)
      if (const auto hit = sweep_point(p0, p1, surface.before(t), surface.after(t))) net += hit->from_outside ? 1 : -1;
    const double turns = winding(surface, surface.present, p1) - winding(surface, surface.previous, p0);
    ASSERT_NEAR(net, turns, 1e-6) << "trial " << trial;
  }
}

/// True if some triangle catches the point on its way from p0 to p1.
bool caught(const MovingSurface& surface, const Vector3d& p0, const Vector3d& p1) {
  for (int t = 0; t < surface.size(); ++t)
    if (sweep_point(p0, p1, surface.before(t), surface.after(t))) return true;
  return false;
}

/// Counts the paths that pass unseen through a place on the surface: `weights` in triangle t at a random
/// time.
template <class Weights>
int leaks(MovingSurface& surface, int trials, Weights&& weights) {
  int lost = 0, crossing = 0;
  for (int trial = 0; trial < trials; ++trial) {
    if (trial % 200 == 0) surface.step(0.002);
    const int t = surface.pick(surface.triangles.size());
    const double time = surface.uniform(0.05, 0.95), length = std::pow(10.0, surface.uniform(-4, 0));
    Triangle at;
    for (int v = 0; v < 3; ++v) at[v] = (1 - time) * surface.before(t)[v] + time * surface.after(t)[v];
    const Vector3d w = weights();
    const Vector3d through = w[0] * at[0] + w[1] * at[1] + w[2] * at[2], path = length * surface.direction();
    const Vector3d p0 = through - time * path, p1 = through + (1 - time) * path;
    const double turns = winding(surface, surface.present, p1) - winding(surface, surface.previous, p0);
    if (std::abs(turns) < 0.5) continue;
    ++crossing;
    lost += !caught(surface, p0, p1);
  }
  EXPECT_GT(crossing, trials / 10);
  return lost;
}

TEST(Sweep, CatchesPointsThatPassThroughEdges) {
  MovingSurface surface(23);
  EXPECT_EQ(leaks(surface, 10000,
                  [&] {
                    const double s = surface.uniform(0, 1);
                    return Vector3d(s, 1 - s, 0);
                  }),
            0);
}

TEST(Sweep, CatchesPointsThatPassThroughVertices) {
  MovingSurface surface(24);
  EXPECT_EQ(leaks(surface, 10000, [] { return Vector3d(1, 0, 0); }), 0);
}

TEST(Sweep, CatchesPointsThatPassThroughSliversAndTheirEdges) {
  MovingSurface surface(25);
  // A node just inside one edge of every triangle splits it into two slim parts and a sliver; the finest
  // slivers have no width in double precision.
  const int count = surface.size();
  for (int t = 0; t < count; ++t) {
    const auto corner = surface.triangles[t];
    const double width = std::pow(10.0, surface.uniform(-18, -3)), s = surface.uniform(0.2, 0.8) * (1 - width);
    const auto split = [&](std::vector<Vector3d>& x) {
      x.push_back(s * x[corner[0]] + (1 - s - width) * x[corner[1]] + width * x[corner[2]]);
    };
    split(surface.rest), split(surface.previous), split(surface.present);
    const int middle = static_cast<int>(surface.rest.size()) - 1;
    surface.triangles[t] = {corner[0], corner[1], middle};
    surface.triangles.push_back({corner[1], corner[2], middle});
    surface.triangles.push_back({corner[2], corner[0], middle});
  }
  int which = 0;
  EXPECT_EQ(leaks(surface, 6000,
                  [&]() -> Vector3d {
                    const double s = surface.uniform(0, 1), r = surface.uniform(0, 1);
                    switch (++which % 3) {
                      case 0:
                        return {s, 1 - s, 0};
                      case 1:
                        return {0, s, 1 - s};
                      default:
                        return {s * r, s * (1 - r), 1 - s};
                    }
                  }),
            0);
}

TEST(Sweep, CatchesFastPointsThatPassThroughAMovingSliverBetweenGoodTriangles) {
  MovingSurface source(27);
  int lost = 0;
  for (int trial = 0; trial < 100000; ++trial) {
    // A node M of triangle ABC, next to its edge AB: ABM is a sliver; D lies beyond the edge.
    const double width = std::pow(10.0, source.uniform(-10, -4)), time = source.uniform(0.05, 0.95);
    const Vector3d along = source.direction(), across = along.cross(source.direction()).normalized();
    const Vector3d a = 0.3 * source.direction();
    enum { A, B, C, D, M };
    std::array<Vector3d, 5> before{a, a + 0.01 * along, a + 0.005 * along + 0.008 * across,
                                   a + 0.005 * along - 0.008 * across};
    std::array<Vector3d, 5> after, at;
    for (int v = 0; v < 4; ++v) after[v] = before[v] + 0.001 * source.direction();
    for (auto* x : {&before, &after}) (*x)[M] = 0.4 * (*x)[A] + (0.6 - width) * (*x)[B] + width * (*x)[C];
    for (int v = 0; v < 5; ++v) at[v] = (1 - time) * before[v] + time * after[v];
    const double s = source.uniform(0.1, 0.9), r = source.uniform(0, 1);
    const Vector3d through = (1 - r) * (s * at[A] + (1 - s) * at[B]) + r * at[M];
    const Vector3d path = std::pow(10.0, source.uniform(-2, 0)) * source.direction();
    bool found = false;
    for (const auto& [i, j, k] : {std::array{A, B, M}, std::array{B, C, M}, std::array{C, A, M}, std::array{B, A, D}})
      found |= sweep_point(through - time * path, through + (1 - time) * path, {before[i], before[j], before[k]},
                           {after[i], after[j], after[k]})
                   .has_value();
    lost += !found;
  }
  EXPECT_EQ(lost, 0);
}

}  // namespace
}  // namespace palpate
