#include "common/contact/patch/half_space.hpp"

#include <cmath>
#include <numbers>

#include "common/kernels/kernels.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Moments = std::array<std::array<Matrix3d, 3>, 3>;

// x asinh(y / |x|), r being the distance: x ln(y + r) but for what cancels over the corners.
double leg(double x, double y, double r) {
  return x == 0 ? 0 : std::copysign(x, x * y) * std::log((std::abs(y) + r) / std::abs(x));
}

// The antiderivative of x / r^2.
double crossed_leg(double x, double y) {
  return (y == 0 ? 0 : 0.5 * y * std::log(x * x + y * y)) + (x == 0 ? 0 : x * std::atan(y / x));
}

HalfSpace::Corner over_corners(double x, double y, double a) {
  HalfSpace::Corner sum{0, 0, 0};
  for (const int sx : {1, -1})
    for (const int sy : {1, -1}) {
      const HalfSpace::Corner c = HalfSpace::corner(x + 0.5 * sx * a, y + 0.5 * sy * a);
      sum.across += sx * sy * c.across;
      sum.along += sx * sy * c.along;
      sum.mixed += sx * sy * c.mixed;
    }
  return sum;
}

}  // namespace

double HalfSpace::scale() const {
  return (1 + poisson) / (std::numbers::pi * young);
}

Matrix3d HalfSpace::at(const Vector3d& d, const Vector3d& normal) const {
  const double r = d.norm();
  const Vector3d across = d - d.dot(normal) * normal;
  const Matrix3d turned = across * normal.transpose();
  return scale() / r *
         ((1 - poisson) * Matrix3d::Identity() + poisson / (r * r) * across * across.transpose() +
          (0.5 - poisson) / r * (turned - turned.transpose()));
}

// The antiderivatives of y^2 / r^3, x^2 / r^3 and x y / r^3.
HalfSpace::Corner HalfSpace::corner(double x, double y) {
  const double r = std::sqrt(x * x + y * y);
  return {leg(x, y, r), leg(y, x, r), -r};
}

double HalfSpace::pressed(const Corner& sum) const {
  return scale() * (1 - poisson) * (sum.across + sum.along);
}

Eigen::Matrix2d HalfSpace::sheared(const Corner& sum) const {
  Eigen::Matrix2d k;
  k << sum.along, sum.mixed, sum.mixed, sum.across;
  k = poisson * k + (1 - poisson) * (sum.along + sum.across) * Eigen::Matrix2d::Identity();
  return scale() * k;
}

double HalfSpace::pressed(double x, double y, double a) const {
  return pressed(over_corners(x, y, a));
}

Eigen::Matrix2d HalfSpace::sheared(double x, double y, double a) const {
  return sheared(over_corners(x, y, a));
}

Eigen::Vector2d HalfSpace::crossed(double x, double y, double a) const {
  Eigen::Vector2d sum(0, 0);
  for (const int sx : {1, -1})
    for (const int sy : {1, -1}) sum += sx * sy * crossed_corner(x + 0.5 * sx * a, y + 0.5 * sy * a);
  return sum;
}

Eigen::Vector2d HalfSpace::crossed_corner(double x, double y) const {
  return (0.5 - poisson) * scale() * Eigen::Vector2d(crossed_leg(x, y), crossed_leg(y, x));
}

Moments kernel_moments(const HalfSpace& half_space, const Triangle& s, const Triangle& t, const Vector3d& normal) {
  std::array<std::array<std::array<double, 10>, 3>, 3> sum;
  kernels::active().kernel_moments(s[0].data(), t[0].data(), normal.data(), half_space.poisson, sum[0][0].data());
  Moments moments;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      const auto& k = sum[a][b];
      moments[a][b] << k[0] + k[1], k[4], k[5], k[4], k[0] + k[2], k[6], k[5], k[6], k[0] + k[3];
      const Matrix3d turned = Vector3d(k[7], k[8], k[9]) * normal.transpose();
      moments[a][b] += (0.5 - half_space.poisson) * (turned - turned.transpose());
      moments[a][b] *= half_space.scale();
    }
  return moments;
}

}  // namespace palpate
