#include "tools/generate/implicit_shapes.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {

double ellipsoid(const Eigen::Vector3d& p, const Eigen::Vector3d& centre, const Eigen::Vector3d& half_axes,
                 const Eigen::Matrix3d& turn) {
  const Eigen::Vector3d q = turn.transpose() * (p - centre);
  const double k0 = q.cwiseQuotient(half_axes).norm();
  const double k1 = q.cwiseQuotient(half_axes.cwiseAbs2()).norm();
  return k1 > 0 ? k0 * (k0 - 1) / k1 : -half_axes.minCoeff();
}

double capsule(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm() - radius;
}

double smooth_union(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * h * k / 6;
}

double smooth_cut(double a, double b, double k) {
  return -smooth_union(-a, b, k);
}

Eigen::Vector3d gradient(const ImplicitShape& shape, const Eigen::Vector3d& p) {
  constexpr double kStep = 1e-6;  // [m]
  Eigen::Vector3d g;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(i);
    g[i] = (shape(p + d) - shape(p - d)) / (2 * kStep);
  }
  return g;
}

Eigen::Vector3d project(const ImplicitShape& shape, Eigen::Vector3d p) {
  constexpr double kMaxStep = 0.01;  // [m]
  for (int step = 0; step < 20; ++step) {
    const double value = shape(p);
    if (std::abs(value) < 1e-9) break;
    const Eigen::Vector3d g = gradient(shape, p);
    const Eigen::Vector3d move = -value / std::max(g.squaredNorm(), 1e-3) * g;
    p += move * std::min(1.0, kMaxStep / move.norm());
  }
  return p;
}

}  // namespace palpate
