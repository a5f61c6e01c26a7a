#include "common/contact/patch/hertz_dent.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kWidest = 0.95;  // of a ball's radius: beyond it is too steep to press
constexpr double kWhole = 0.5;    // of the reach

/// Of pressures as Hertz's with resultant 1 over a disc of radius a, at a distance r from its middle: the integral of
/// p / distance [1/m], its slope there [1/m^2], and its mean over the disc of radius r, halved [1/m].
struct Potential {
  double value, slope, half_mean;
};

Potential potential(double r, double a) {
  const double per = 3 / (4 * a * a * a);
  if (r <= a) {
    const double inside = 0.5 * kPi * per;
    return {inside * (2 * a * a - r * r), -2 * inside * r, inside * (a * a - 0.25 * r * r)};
  }
  const double angle = std::asin(a / r), beside = a * std::sqrt(r * r - a * a), square = a * a / (r * r);
  return {per * ((2 * a * a - r * r) * angle + beside), 2 * per * (beside / r - r * angle),
          per * ((a * a - 0.25 * r * r) * angle + beside * (0.25 + 0.5 * square))};
}

/// Of the same pressures the part within the circle of radius r, over r^2 [1/m^2], and the slope of that [1/m^3].
struct Enclosed {
  double value, slope;
};

Enclosed enclosed(double r, double a) {
  if (r >= a) return {1 / (r * r), -2 / (r * r * r)};
  const double left = std::sqrt(1 - r * r / (a * a)), square = a * a * (1 + left);
  return {(1 + left + left * left) / square, -r * (2 + left) / (square * square)};
}

/// The surface's normal about a place and the middle of a dent; zero where they look away from each other.
Vector3d common_normal(const Vector3d& a, const Vector3d& b) {
  return a.dot(b) > 0 ? Vector3d((a + b).normalized()) : Vector3d::Zero();
}

}  // namespace

double HertzDent::disc_under(double radius, double pressing, const HalfSpace& half_space) {
  const double per_modulus = kPi * half_space.scale() * (1 - half_space.poisson);
  return std::min(std::cbrt(0.75 * pressing * radius * per_modulus), kWidest * radius);
}

double HertzDent::share(const Vector3d& place) const {
  const double s = std::clamp((1 - (place - middle).norm() / reach) / (1 - kWhole), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

// Shear moves the surface by the second derivatives of the potential of p * distance, as Cerruti's kernel is made of
// those of the distance. What pressure does across and shear along the normal is what a point force in the middle does,
// of as much as lies within the circle.
Vector3d HertzDent::field(const Vector3d& place, const Vector3d& normal) const {
  const Vector3d n = common_normal(normal, outward);
  if (n.isZero(0)) return Vector3d::Zero();
  const Vector3d d = place - middle;
  const double r = d.norm(), nu = half_space.poisson;
  const auto [value, slope, half_mean] = potential(r, disc);
  const Vector3d across = d - d.dot(n) * n, along = force.dot(n) * n, shear = force - along;
  Vector3d sum = (1 - nu) * value * along + (value - nu * half_mean) * shear;
  if (r > 0) sum -= nu * (value - 2 * half_mean) * across.dot(shear) / (r * r) * across;
  sum += (0.5 - nu) * enclosed(r, disc).value * (n.dot(along) * across - across.dot(shear) * n);
  return half_space.scale() * sum;
}

Vector3d HertzDent::displacement(const Vector3d& place, const Vector3d& normal) const {
  const double part = share(place);
  return part > 0 ? Vector3d(part * field(place, normal)) : Vector3d::Zero();
}

Vector3d HertzDent::slope(const Vector3d& place, const Vector3d& normal) const {
  const Vector3d n = common_normal(normal, outward), d = place - middle;
  const double r = d.norm();
  if (n.isZero(0) || r == 0 || r >= reach) return Vector3d::Zero();
  const double s = std::clamp((1 - r / reach) / (1 - kWhole), 0.0, 1.0);
  const double part = s * s * (3 - 2 * s), fades = -6 * s * (1 - s) / (reach * (1 - kWhole));
  const auto [value, slope, half_mean] = potential(r, disc);
  const auto [share, share_slope] = enclosed(r, disc);
  const double nu = half_space.poisson;
  const Vector3d across = d - d.dot(n) * n, shear = force - force.dot(n) * n;
  const double grows = (1 - nu) * force.dot(n) * (part * slope + fades * value) -
                       (0.5 - nu) * across.dot(shear) * (part * share_slope + fades * share);
  return half_space.scale() * (grows / r * across - (0.5 - nu) * part * share * shear);
}

}  // namespace palpate
