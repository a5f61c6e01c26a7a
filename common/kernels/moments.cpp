#include <immintrin.h>

#include "common/kernels/vector.hpp"

namespace palpate::kernels::PALPATE_LEVEL {
namespace {

using V = Pack<double>;
constexpr int kWidth = Vector<double>::kWidth;
constexpr int kKernel = 10;  // isotropic; xx, yy, zz, xy, xz, yz of what is added to it; x, y, z of h

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

template <class T>
struct PointOf {
  T x, y, z;
};
using Point = PointOf<double>;
using Points = PointOf<V>;

template <class A, class B>
inline auto operator-(const PointOf<A>& a, const PointOf<B>& b) {
  return PointOf<decltype(a.x - b.x)>{a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class A, class B>
inline auto operator+(const PointOf<A>& a, const PointOf<B>& b) {
  return PointOf<decltype(a.x + b.x)>{a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class A, class B>
inline auto operator*(const A& s, const PointOf<B>& a) {
  return PointOf<decltype(s * a.x)>{s * a.x, s * a.y, s * a.z};
}
template <class A, class B>
inline auto dot(const PointOf<A>& a, const PointOf<B>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
inline PointOf<T> cross(const PointOf<T>& a, const PointOf<T>& b) {
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

// Gauss-Legendre of four points on [0, 1].
constexpr int kGauss = 4;
constexpr double kNode[kGauss] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
constexpr double kNodeWeight[kGauss] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                        0.17392742256872693};

struct Surface {
  Point normal;
  double poisson;
};

/// Of the points of s, over points of t: by barycentric coordinate and part of the kernel.
struct Sums {
  V at[3][kKernel] = {};

  /// The kernel at the distances d, r long, by `share`, which is a weight over r, by coordinate.
  inline void add(const Surface& of, const Points& d, V over_r, const V (&share)[3]) {
    const V stretch = of.poisson * over_r * over_r;
    const Points h = d - dot(d, of.normal) * of.normal;
    const V bx = stretch * h.x, by = stretch * h.y;
    const V k[kKernel] = {
        V{} + (1 - of.poisson), h.x * bx,     h.y * by,    h.z * (stretch * h.z), h.x * by, h.z * bx, h.z * by,
        over_r * h.x,           over_r * h.y, over_r * h.z};
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < kKernel; ++i) at[c][i] += share[c] * k[i];
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
  template <class T>
  PointOf<T> place(T a, T b, T c) const {
    return {a * at[0].x + b * at[1].x + c * at[2].x, a * at[0].y + b * at[1].y + c * at[2].y,
            a * at[0].z + b * at[1].z + c * at[2].z};
  }
};

/// `f` of each.
template <class F>
inline V each(V x, F f) {
  for (int i = 0; i < kWidth; ++i) x[i] = f(x[i]);
  return x;
}

/// exp(asinh(x)).
inline V exp_asinh(V x) {
  const V far = x < 0 ? -x : x, grown = far + root(far * far + 1);
  return x < 0 ? 1 / grown : grown;
}

/// The integral over t of L_b(y) K(x - y), for each x on it or near it: t is the signed sum of three triangles with a
/// corner below x, y = foot + s (edge point - foot) in each. r = |x - y| in place of s, and asinh of the way along the
/// edge over the foot's distance from it, leave no singularity, on the plane of t or off it; r goes by squares, so that
/// s is smooth too.
inline void near_integral(const Surface& of, const Points& x, const Corners& t, Sums& sums) {
  const Point up = 1 / (2 * t.area) * cross(t.at[1] - t.at[0], t.at[2] - t.at[0]);
  const V signed_height = dot(x - t.at[0], up), height = signed_height < 0 ? -signed_height : signed_height;
  const Points above = signed_height * up, foot = x - above;
  const Points out[3] = {t.at[0] - foot, t.at[1] - foot, t.at[2] - foot};
  V twice[3], of_foot[3];
  for (int e = 0; e < 3; ++e) {
    twice[e] = dot(cross(out[e], out[(e + 1) % 3]), up);
    of_foot[(e + 2) % 3] = twice[e] / (2 * t.area);
  }
  for (int e = 0; e < 3; ++e) {
    const int next = (e + 1) % 3, other = (e + 2) % 3;
    const Point edge = t.at[next] - t.at[e];
    const double along = length(edge);
    const V signed_distance = twice[e] / along, far = signed_distance < 0 ? -signed_distance : signed_distance;
    const V distance = far < 1e-9 * along ? along + 0 * far : far;  // of the foot; on the edge it gives nothing
    const V sign = far < 1e-9 * along ? 0 * far : signed_distance / far;
    const V begin = dot(out[e], edge) / along;
    const V first = exp_asinh(begin / distance), last = exp_asinh((begin + along) / distance);
    const V whole = each(last / first, [](double ratio) { return __builtin_log(ratio); }), middle = root(first * last);
    for (int i = 0; i < kGauss; ++i) {
      const V grown = middle * each((kNode[i] - 0.5) * whole, [](double way) { return __builtin_exp(way); });
      const V at = 0.5 * distance * (grown - 1 / grown), rho = 0.5 * distance * (grown + 1 / grown);
      const V u = (at - begin) / along, range = root(rho * rho + height * height) - height, over_rho = 1 / rho;
      const V area = sign * kNodeWeight[i] * whole * distance * over_rho * range;  // over r
      const Points reach = out[e] + u * edge;
      for (int j = 0; j < kGauss; ++j) {
        const V r = height + kNode[j] * kNode[j] * range, s = kNode[j] * root(range * (r + height)) * over_rho;
        const V by = 2 * kNode[j] * kNodeWeight[j] * area;
        V share[3];
        share[e] = by * (of_foot[e] + s * (1 - u - of_foot[e]));
        share[next] = by * (of_foot[next] + s * (u - of_foot[next]));
        share[other] = by * (of_foot[other] - s * of_foot[other]);
        sums.add(of, above - s * reach, 1 / r, share);
      }
    }
  }
}

inline void far_integral(const Surface& of, const Points& x, const Corners& t, Sums& sums) {
  for (int i = 0; i < kPoints; ++i) {
    const Points d = x - t.place(kAt[0][i], kAt[1][i], kAt[2][i]);
    const V over_r = 1 / root(dot(d, d)), by = kWeight[i] * t.area * over_r;
    sums.add(of, d, over_r, {kAt[0][i] * by, kAt[1][i] * by, kAt[2][i] * by});
  }
}

/// Points of s with what they weigh, their barycentric coordinates in all of s.
struct Outer {
  V at[3], weight;
};

/// Of the corners' pairs.
struct Moments {
  V at[3][3][kKernel] = {};

  /// What points of s give.
  template <bool Near>
  inline void add(const Surface& of, const Corners& s, const Corners& t, const Outer& p) {
    Sums sums;
    const Points x = s.place(p.at[0], p.at[1], p.at[2]);
    if (Near)
      near_integral(of, x, t, sums);
    else
      far_integral(of, x, t, sums);
    for (int b = 0; b < 3; ++b)
      for (int i = 0; i < kKernel; ++i) {
        const V inner = p.weight * s.area * sums.at[b][i];
        for (int a = 0; a < 3; ++a) at[a][b][i] += p.at[a] * inner;
      }
  }

  template <bool Near>
  inline void add_whole(const Surface& of, const Corners& s, const Corners& t) {
    for (int p = 0; p < 8; p += kWidth)
      add<Near>(of, s, t, {{load(kAt[0] + p), load(kAt[1] + p), load(kAt[2] + p)}, load(kWeight + p)});
  }

  /// In the four triangles that the middles of the edges make: the inner integral has a steep end at a common edge.
  inline void add_split(const Surface& of, const Corners& s, const Corners& t) {
    for (int part = 0; part < 4; ++part)
      for (int p = 0; p < 8; p += kWidth) {
        Outer points{{}, 0.25 * load(kWeight + p)};
        for (int c = 0; c < 3; ++c) {  // at a corner, or turned about in the middle
          const V of_part = load(kAt[c] + p);
          points.at[c] = part < 3 ? 0.5 * (of_part + (c == part ? 1.0 : 0.0)) : 0.5 * (1 - of_part);
        }
        add<true>(of, s, t, points);
      }
  }
};

inline double sum_of(V v) {
  double sum = v[0];
  for (int i = 1; i < kWidth; ++i) sum += v[i];
  return sum;
}

}  // namespace

void kernel_moments(const double* s9, const double* t9, const double* normal, double poisson, double* out) {
  const Corners s(s9), t(t9);
  const Surface of{{normal[0], normal[1], normal[2]}, poisson};
  const double apart = length(s.middle() - t.middle()) / (s.radius() + t.radius());
  Moments moments;
  if (apart > kFarAway)
    moments.add_whole<false>(of, s, t);
  else if (apart > kCommonEdge)
    moments.add_whole<true>(of, s, t);
  else
    moments.add_split(of, s, t);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (int i = 0; i < kKernel; ++i) out[(3 * a + b) * kKernel + i] = sum_of(moments.at[a][b][i]);
}

}  // namespace palpate::kernels::PALPATE_LEVEL
