#include "common/contact/patch/half_space.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "common/geometry/barycentric.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Moments = std::array<std::array<Matrix3d, 3>, 3>;

constexpr double kFarAway = 3;  // mean radii between two triangles' middles, beyond which plain quadrature serves

struct Weighted {
  Vector3d at;  // barycentric
  double weight;
};

// Exact for polynomials of degree five (Radon 1948).
const std::array<Weighted, 7>& points_of_triangle() {
  static const std::array<Weighted, 7> points = [] {
    const double root = std::sqrt(15.0);
    const double a = (6 - root) / 21, b = (6 + root) / 21;
    const double of_a = (155 - root) / 1200, of_b = (155 + root) / 1200;
    return std::array<Weighted, 7>{{{Vector3d::Constant(1.0 / 3), 9.0 / 40},
                                    {{1 - 2 * a, a, a}, of_a},
                                    {{a, 1 - 2 * a, a}, of_a},
                                    {{a, a, 1 - 2 * a}, of_a},
                                    {{1 - 2 * b, b, b}, of_b},
                                    {{b, 1 - 2 * b, b}, of_b},
                                    {{b, b, 1 - 2 * b}, of_b}}};
  }();
  return points;
}

// Gauss-Legendre on [0, 1].
constexpr std::array<double, 2> kAlong{0.21132486540518713, 0.78867513459481287};
constexpr std::array<std::array<double, 2>, 6> kAcross{{{0.03376524289842399, 0.08566224618958517},
                                                        {0.16939530676686774, 0.18038078652406930},
                                                        {0.38069040695840155, 0.23395696728634552},
                                                        {0.61930959304159845, 0.23395696728634552},
                                                        {0.83060469323313226, 0.18038078652406930},
                                                        {0.96623475710157601, 0.08566224618958517}}};

double area(const Triangle& t) {
  return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
}

Vector3d place(const Triangle& t, const Vector3d& weights) {
  return weights[0] * t[0] + weights[1] * t[1] + weights[2] * t[2];
}

// K = isotropic I + a matrix that is its own transpose, of which the upper part is kept.
struct Symmetric {
  std::array<double, 7> at{};  // isotropic; xx, yy, zz, xy, xz, yz

  void add(double weight, const Symmetric& k) {
    for (int i = 0; i < 7; ++i) at[i] += weight * k.at[i];
  }
  Matrix3d matrix() const {
    Matrix3d m;
    m << at[0] + at[1], at[4], at[5], at[4], at[0] + at[2], at[6], at[5], at[6], at[0] + at[3];
    return m;
  }
};
using OfCorners = std::array<Symmetric, 3>;

Symmetric kernel(const HalfSpace& half_space, const Vector3d& d, const Vector3d& normal) {
  const double over_r = 1 / d.norm();
  const double isotropic = half_space.scale() * (1 - half_space.poisson) * over_r;
  const double stretch = half_space.scale() * half_space.poisson * over_r * over_r * over_r;
  const Vector3d a = d - d.dot(normal) * normal, b = stretch * a;
  return {{isotropic, a.x() * b.x(), a.y() * b.y(), a.z() * b.z(), a.x() * b.y(), a.x() * b.z(), a.y() * b.z()}};
}

// The integral over t of L_b(y) K(x - y), for x on or near its plane: t is the signed sum of three triangles with a
// corner below x, and in each, y = foot + s (edge point - foot), dy = 2 area s ds du takes the 1/r away.
OfCorners near_integral(const HalfSpace& half_space, const Vector3d& x, const Triangle& t, const Vector3d& normal) {
  OfCorners sum;
  const Vector3d up = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  const Vector3d foot = x - up.dot(x - t[0]) * up;
  const Vector3d of_foot = plane_coordinates(t, foot);
  for (int e = 0; e < 3; ++e) {
    const int next = (e + 1) % 3;
    const Vector3d &a = t[e], &b = t[next];
    const double twice = up.dot((a - foot).cross(b - foot));
    if (std::abs(twice) < 1e-12 * (b - a).squaredNorm()) continue;
    for (const auto& [u, weight_u] : kAcross) {
      const Vector3d edge = a + u * (b - a);
      Vector3d of_edge = Vector3d::Zero();
      of_edge[e] = 1 - u;
      of_edge[next] = u;
      for (const double s : kAlong) {
        const Vector3d y = foot + s * (edge - foot), weights = of_foot + s * (of_edge - of_foot);
        const Symmetric k = kernel(half_space, x - y, normal);
        for (int c = 0; c < 3; ++c) sum[c].add(0.5 * weight_u * s * twice * weights[c], k);
      }
    }
  }
  return sum;
}

OfCorners far_integral(const HalfSpace& half_space, const Vector3d& x, const Triangle& t, const Vector3d& normal) {
  OfCorners sum;
  const double whole = area(t);
  for (const auto& [at, weight] : points_of_triangle()) {
    const Symmetric k = kernel(half_space, x - place(t, at), normal);
    for (int c = 0; c < 3; ++c) sum[c].add(weight * whole * at[c], k);
  }
  return sum;
}

// Over the corners of a square about (x, y), in turn with signs + - - +.
template <class Corner>
double over_corners(double x, double y, double a, Corner&& corner) {
  double sum = 0;
  for (const int sx : {1, -1})
    for (const int sy : {1, -1}) sum += sx * sy * corner(x + 0.5 * sx * a, y + 0.5 * sy * a);
  return sum;
}

// x ln(y + r) but for what cancels over the corners.
double leg(double x, double y) {
  return x == 0 ? 0 : x * std::asinh(y / std::abs(x));
}

}  // namespace

double HalfSpace::scale() const {
  return (1 + poisson) / (std::numbers::pi * young);
}

Matrix3d HalfSpace::at(const Vector3d& d, const Vector3d& normal) const {
  return kernel(*this, d, normal).matrix();
}

double HalfSpace::pressed(double x, double y, double a) const {
  const double whole = over_corners(x, y, a, [](double p, double q) { return leg(p, q) + leg(q, p); });
  return scale() * (1 - poisson) * whole;
}

Eigen::Matrix2d HalfSpace::sheared(double x, double y, double a) const {
  const double across = over_corners(x, y, a, [](double p, double q) { return leg(p, q); });  // y^2 / r^3
  const double along = over_corners(x, y, a, [](double p, double q) { return leg(q, p); });   // x^2 / r^3
  const double mixed = over_corners(x, y, a, [](double p, double q) { return -std::hypot(p, q); });
  Eigen::Matrix2d k;
  k << along, mixed, mixed, across;
  k = poisson * k + (1 - poisson) * (along + across) * Eigen::Matrix2d::Identity();
  return scale() * k;
}

Moments kernel_moments(const HalfSpace& half_space, const Triangle& s, const Triangle& t, const Vector3d& normal) {
  const double whole = area(s);
  const Vector3d apart = (s[0] + s[1] + s[2] - t[0] - t[1] - t[2]) / 3;
  const bool far = apart.squaredNorm() > kFarAway * kFarAway * (whole + area(t));
  std::array<OfCorners, 3> sum;
  for (const auto& [at, weight] : points_of_triangle()) {
    const Vector3d x = place(s, at);
    const OfCorners inner = far ? far_integral(half_space, x, t, normal) : near_integral(half_space, x, t, normal);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) sum[a][b].add(weight * whole * at[a], inner[b]);
  }
  Moments moments;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) moments[a][b] = sum[a][b].matrix();
  return moments;
}

}  // namespace palpate
