#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::testing {

/// A rigid sphere pressed without friction into an elastic half-space, by pressures on rings about its axis. They push
/// along the sphere's own normals, and the surface goes aside: by as much the sphere is less deep there. The rings'
/// displacements are in closed form: of uniform discs (Love 1929), and of shear along the radius by integrals of Bessel
/// functions. Linear in what the surface goes aside.
class SphereOnHalfSpace {
 public:
  SphereOnHalfSpace(double radius, double young, double poisson) : radius_(radius), young_(young), poisson_(poisson) {}

  /// [N] along the axis, at `depth` [m].
  double force(double depth) const {
    const double reach = 0.995 * std::sqrt(depth * (2 * radius_ - depth)), width = reach / kRings;
    const auto middle = [&](int i) { return (i + 0.5) * width; };
    Eigen::VectorXd gap(kRings), lean(kRings), pressure;
    Eigen::MatrixXd give(kRings, kRings);
    for (int i = 0; i < kRings; ++i) {
      const double rise = std::sqrt(radius_ * radius_ - middle(i) * middle(i));
      gap[i] = depth - radius_ + rise;
      lean[i] = middle(i) / rise;
    }
    for (int i = 0; i < kRings; ++i)
      for (int j = 0; j < kRings; ++j) {
        const double r = middle(i), in = j * width, out = (j + 1) * width;
        give(i, j) = sunk(r, out) - sunk(r, in) + lean[i] * (drawn(r, out) - drawn(r, in)) +
                     (lean[i] * pushed(r, in, width) - lifted(r, in, width)) * lean[j];
      }
    int touching = kRings;  // from the axis outwards
    do {
      pressure = give.topLeftCorner(touching, touching).partialPivLu().solve(gap.head(touching));
      const auto first = std::find_if(pressure.begin(), pressure.end(), [](double p) { return p < 0; });
      touching = static_cast<int>(first - pressure.begin());
    } while (touching < pressure.size());
    double sum = 0;
    for (int i = 0; i < touching; ++i) sum += pressure[i] * std::numbers::pi * width * width * (2 * i + 1);
    return sum;
  }

 private:
  static constexpr int kRings = 120, kParts = 16;

  // [m/Pa] at a distance from the axis, by unit pressure on a disc of a radius: into the half-space, and outwards.
  double sunk(double r, double disc) const {
    if (disc == 0) return 0;
    const double per = 4 * (1 - poisson_ * poisson_) / (std::numbers::pi * young_);
    if (r < disc) return per * disc * std::comp_ellint_2(r / disc);
    const double k = disc / r;
    return per * r * (std::comp_ellint_2(k) - (1 - k * k) * std::comp_ellint_1(k));
  }
  double drawn(double r, double disc) const { return -per_crossed() / 2 * (r < disc ? r : disc * disc / r); }
  // [m/Pa] likewise, by unit shear outwards on a ring: outwards, and into the half-space the other way.
  double pushed(double r, double in, double width) const {
    double sum = 0;
    for (int part = 0; part < kParts; ++part) {
      const double rho = in + (part + 0.5) / kParts * width, least = std::min(r, rho);
      const double k = std::min(least / std::max(r, rho), 1 - 1e-9);
      sum += rho / least * (std::comp_ellint_1(k) - std::comp_ellint_2(k));
    }
    return 4 * (1 - poisson_ * poisson_) / (std::numbers::pi * young_) * sum / kParts * width;
  }
  double lifted(double r, double in, double width) const {
    return per_crossed() * std::clamp(in + width - r, 0.0, width);
  }
  double per_crossed() const { return (1 - 2 * poisson_) * (1 + poisson_) / young_; }

  double radius_, young_, poisson_;
};

}  // namespace palpate::testing
