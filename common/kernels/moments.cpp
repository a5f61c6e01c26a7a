#include <immintrin.h>

#include "common/kernels/vector.hpp"

namespace palpate::kernels::PALPATE_LEVEL {
namespace {

using V = Pack<double>;
constexpr int kWidth = Vector<double>::kWidth;
constexpr int kKernel = 7;  // isotropic; xx, yy, zz, xy, xz, yz of what is added to it

// Between two triangles' middles, in sums of their radii: beyond the first plain quadrature serves; within the second
// they have an edge in common, or are one.
constexpr double kFarAway = 1.3, kCommonEdge = 0.7;

inline V root(V x) {
#if defined(__AVX512F__)
  return _mm512_maskz_sqrt_pd(0xff, x);  // without the mask GCC 12 warns of a value of its own
#elif defined(__AVX2__)
  return _mm256_sqrt_pd(x);
#else
  return _mm_sqrt_pd(x);
#endif
}

struct Point {
  double x, y, z;
};
inline Point operator-(const Point& a, const Point& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Point operator*(double s, const Point& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline double dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Point& a) {
  return __builtin_sqrt(dot(a, a));
}

// Exact for polynomials of degree five (Radon 1948): barycentric coordinates by coordinate, and weights; an eighth
// point of no weight fills the vectors.
constexpr double kRoot = 3.872983346207417;  // of 15
constexpr double kA = (6 - kRoot) / 21, kB = (6 + kRoot) / 21, kThird = 1.0 / 3;
constexpr double kOfA = (155 - kRoot) / 1200, kOfB = (155 + kRoot) / 1200;
constexpr int kPoints = 7;
alignas(64) constexpr double kAt[3][8] = {{kThird, 1 - 2 * kA, kA, kA, 1 - 2 * kB, kB, kB, kThird},
                                          {kThird, kA, 1 - 2 * kA, kA, kB, 1 - 2 * kB, kB, kThird},
                                          {kThird, kA, kA, 1 - 2 * kA, kB, kB, 1 - 2 * kB, kThird}};
alignas(64) constexpr double kWeight[8] = {9.0 / 40, kOfA, kOfA, kOfA, kOfB, kOfB, kOfB, 0};

// Gauss-Legendre of four points on [0, 1], as the square of (along an edge, out to it) has it.
constexpr int kGauss = 4, kPolar = kGauss * kGauss;
constexpr double kNode[kGauss] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
constexpr double kNodeWeight[kGauss] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                        0.17392742256872693};

#define PALPATE_FOUR_TIMES(a) \
  { a[0], a[1], a[2], a[3], a[0], a[1], a[2], a[3], a[0], a[1], a[2], a[3], a[0], a[1], a[2], a[3] }
alignas(64) constexpr double kOut[kPolar] = PALPATE_FOUR_TIMES(kNode);
alignas(64) constexpr double kOutWeight[kPolar] = PALPATE_FOUR_TIMES(kNodeWeight);

struct Surface {
  Point normal;
  double poisson;
};

/// Sums over points of t: barycentric coordinate, part of the kernel.
struct Sums {
  V at[3][kKernel] = {};

  /// The points' kernel at the distances (dx, dy, dz), by `weight` and coordinate.
  inline void add(const Surface& of, V dx, V dy, V dz, const V (&weight)[3]) {
    const V over_r = 1 / root(dx * dx + dy * dy + dz * dz);
    const V stretch = of.poisson * over_r * over_r * over_r;
    const V up = dx * of.normal.x + dy * of.normal.y + dz * of.normal.z;
    const V x = dx - up * of.normal.x, y = dy - up * of.normal.y, z = dz - up * of.normal.z;
    const V bx = stretch * x, by = stretch * y;
    const V k[kKernel] = {(1 - of.poisson) * over_r, x * bx, y * by, z * (stretch * z), x * by, z * bx, z * by};
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < kKernel; ++i) at[c][i] += weight[c] * k[i];
  }
};

struct Corners {
  Point at[3];
  double area;

  Corners(const Point& a, const Point& b, const Point& c) : at{a, b, c}, area(0.5 * length(cross(b - a, c - a))) {}
  explicit Corners(const double* t) : Corners({t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}) {}
  Point middle() const { return place(kThird, kThird, kThird); }
  double radius() const {  // about the middle
    double farthest = 0;
    for (const Point& c : at) {
      const double r = length(c - middle());
      farthest = r > farthest ? r : farthest;
    }
    return farthest;
  }
  Point place(double a, double b, double c) const {
    return {a * at[0].x + b * at[1].x + c * at[2].x, a * at[0].y + b * at[1].y + c * at[2].y,
            a * at[0].z + b * at[1].z + c * at[2].z};
  }
};

/// What an edge of t gives to the integral over t of L_b(y) K(x - y), with the triangle between the edge and the foot
/// of x: y = foot + s (edge point - foot). r = |x - y| in place of s, and asinh of the way along the edge over the
/// foot's distance from it, leave no singularity, on the plane of t or off it.
struct Fan {
  double along[kPolar], out[kPolar], weight[kPolar];  ///< along the edge, s; of which the last is an area

  /// `distance` of the foot from the edge, which goes from `begin` to `end` along itself as seen from there; `height`
  /// of x.
  Fan(double distance, double begin, double end, double height) {
    const double first = __builtin_asinh(begin / distance), whole = __builtin_asinh(end / distance) - first;
    double far[kPolar];  // of the edge's point from the foot
    for (int i = 0; i < kGauss; ++i) {
      const double grown = __builtin_exp(first + kNode[i] * whole), less = 1 / grown;
      const double at = 0.5 * distance * (grown - less), rho = 0.5 * distance * (grown + less);
      const double u = (at - begin) / (end - begin), share = kNodeWeight[i] * whole * distance / rho;
      for (int j = kGauss * i; j < kGauss * (i + 1); ++j) along[j] = u, far[j] = rho, weight[j] = share;
    }
    for (int i = 0; i < kPolar; i += kWidth) {
      const V rho = load(far + i), range = root(rho * rho + height * height) - height;
      const V beyond = load(kOut + i) * range, r = height + beyond;
      store(out + i, root(beyond * (r + height)) / rho);
      store(weight + i, load(weight + i) * load(kOutWeight + i) * range * r);
    }
  }
};

/// The integral over t of L_b(y) K(x - y), for x on it or near it: t is the signed sum of three triangles with a corner
/// below x.
inline void near_integral(const Surface& of, const Point& x, const Corners& t, Sums& sums) {
  const Point up = 1 / (2 * t.area) * cross(t.at[1] - t.at[0], t.at[2] - t.at[0]);
  const double height = dot(up, x - t.at[0]);
  const Point above = height * up, foot = x - above;
  Point out[3];
  for (int c = 0; c < 3; ++c) out[c] = t.at[c] - foot;
  double twice[3], of_foot[3];
  for (int e = 0; e < 3; ++e) {
    twice[e] = dot(up, cross(out[e], out[(e + 1) % 3]));
    of_foot[(e + 2) % 3] = twice[e] / (2 * t.area);
  }
  for (int e = 0; e < 3; ++e) {
    const int next = (e + 1) % 3, other = (e + 2) % 3;
    const Point edge = out[next] - out[e];
    const double length_of_edge = length(edge), distance = __builtin_fabs(twice[e]) / length_of_edge;
    if (distance < 1e-9 * length_of_edge) continue;
    const Fan fan(distance, dot(out[e], edge) / length_of_edge, dot(out[next], edge) / length_of_edge,
                  __builtin_fabs(height));
    for (int i = 0; i < kPolar; i += kWidth) {
      const V u = load(fan.along + i), s = load(fan.out + i);
      const V share = twice[e] < 0 ? -load(fan.weight + i) : load(fan.weight + i);
      V weight[3];
      weight[e] = share * (of_foot[e] + s * (1 - u - of_foot[e]));
      weight[next] = share * (of_foot[next] + s * (u - of_foot[next]));
      weight[other] = share * (of_foot[other] - s * of_foot[other]);
      sums.add(of, above.x - s * (out[e].x + u * edge.x), above.y - s * (out[e].y + u * edge.y),
               above.z - s * (out[e].z + u * edge.z), weight);
    }
  }
}

inline void far_integral(const Surface& of, const Point& x, const Corners& t, Sums& sums) {
  for (int i = 0; i < kPoints; i += kWidth) {
    const V a = load(kAt[0] + i), b = load(kAt[1] + i), c = load(kAt[2] + i), w = load(kWeight + i) * t.area;
    const V weight[3] = {w * a, w * b, w * c};
    sums.add(of, x.x - (a * t.at[0].x + b * t.at[1].x + c * t.at[2].x),
             x.y - (a * t.at[0].y + b * t.at[1].y + c * t.at[2].y),
             x.z - (a * t.at[0].z + b * t.at[1].z + c * t.at[2].z), weight);
  }
}

inline double sum_of(V v) {
  double sum = v[0];
  for (int i = 1; i < kWidth; ++i) sum += v[i];
  return sum;
}

/// Points of s with what they weigh, their barycentric coordinates in all of s.
struct Outer {
  double at[3], weight;
};

/// out += what one point gives.
template <bool Near>
inline void add_point(const Surface& of, const Corners& s, const Corners& t, const Outer& p, double* out) {
  Sums sums;
  const Point x = s.place(p.at[0], p.at[1], p.at[2]);
  if (Near)
    near_integral(of, x, t, sums);
  else
    far_integral(of, x, t, sums);
  for (int b = 0; b < 3; ++b)
    for (int i = 0; i < kKernel; ++i) {
      const double inner = p.weight * s.area * sum_of(sums.at[b][i]);
      for (int a = 0; a < 3; ++a) out[(3 * a + b) * kKernel + i] += p.at[a] * inner;
    }
}

template <bool Near>
inline void moments(const Surface& of, const Corners& s, const Corners& t, double* out) {
  for (int p = 0; p < kPoints; ++p) add_point<Near>(of, s, t, {{kAt[0][p], kAt[1][p], kAt[2][p]}, kWeight[p]}, out);
}

/// In the four triangles that the middles of the edges make: the inner integral has a steep end at a common edge.
inline void split_moments(const Surface& of, const Corners& s, const Corners& t, double* out) {
  for (int part = 0; part < 4; ++part)
    for (int p = 0; p < kPoints; ++p) {
      Outer point{{}, 0.25 * kWeight[p]};
      for (int c = 0; c < 3; ++c)  // at a corner, or turned about in the middle
        point.at[c] = part < 3 ? 0.5 * (kAt[c][p] + (c == part)) : 0.5 * (1 - kAt[c][p]);
      add_point<true>(of, s, t, point, out);
    }
}

}  // namespace

void kernel_moments(const double* s9, const double* t9, const double* normal, double poisson, double* out) {
  const Corners s(s9), t(t9);
  const Surface of{{normal[0], normal[1], normal[2]}, poisson};
  for (int i = 0; i < 9 * kKernel; ++i) out[i] = 0;
  const double apart = length(s.middle() - t.middle()) / (s.radius() + t.radius());
  if (apart > kFarAway)
    moments<false>(of, s, t, out);
  else if (apart > kCommonEdge)
    moments<true>(of, s, t, out);
  else
    split_moments(of, s, t, out);
}

}  // namespace palpate::kernels::PALPATE_LEVEL
