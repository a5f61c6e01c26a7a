#include "common/contact/patch/half_space.hpp"

#include <cmath>
#include <numbers>

#include "common/kernels/kernels.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Moments = std::array<std::array<Matrix3d, 3>, 3>;

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
  const double r = d.norm();
  const Vector3d across = d - d.dot(normal) * normal;
  return scale() / r * ((1 - poisson) * Matrix3d::Identity() + poisson / (r * r) * across * across.transpose());
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
  std::array<std::array<std::array<double, 7>, 3>, 3> sum;
  kernels::active().kernel_moments(s[0].data(), t[0].data(), normal.data(), half_space.poisson, sum[0][0].data());
  Moments moments;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      const auto& k = sum[a][b];
      moments[a][b] << k[0] + k[1], k[4], k[5], k[4], k[0] + k[2], k[6], k[5], k[6], k[0] + k[3];
      moments[a][b] *= half_space.scale();
    }
  return moments;
}

}  // namespace palpate
