#include "common/dynamics/stability.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "common/geometry/principal_axes.hpp"

namespace palpate {
namespace {

/// Where the stability region of classical RK4 ends on the negative real axis.
constexpr double kRk4RealLimit = 2.785293563405282;
/// A radius about the origin that encloses the region.
constexpr double kRk4Radius = 3.1;

double growth_rk4(std::complex<double> z) {
  return std::abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0))));
}

/// The largest factor up to which a left-half-plane eigenvalue may be scaled: the region is star-shaped
/// there.
double max_scale_rk4(std::complex<double> eigenvalue) {
  double stable = 0, unstable = kRk4Radius / std::abs(eigenvalue);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (stable + unstable);
    (growth_rk4(middle * eigenvalue) <= 1 ? stable : unstable) = middle;
  }
  return stable;
}

/// Eigenvalues of the modes: real ones down to -a, and complex pairs with real part -a/2 up to the bound.
double max_step_rk4(double bound, double damping) {
  if (damping == 0) return 2 * std::sqrt(2.0) / bound;
  const double slow = kRk4RealLimit / damping, square = bound * bound - 0.25 * damping * damping;
  if (square <= 0) return slow;
  return std::min(slow, max_scale_rk4({-0.5 * damping, std::sqrt(square)}));
}

constexpr double kRounding = 1 + 1e-12;

/// Principal values of G = sum g_j g_j^T [1/m^2], ascending.
Eigen::Vector3d principal_gram(const TetGradients& tet) {
  const Eigen::Matrix3d gram = tet.gradient.transpose() * tet.gradient;
  return principal_values(gram).cwiseMax(0);
}

/// [Pa/m^2] of the three F_aa in the principal axes.
double largest_stretch(const Eigen::Vector3d& square, const Lame& lame) {
  const Eigen::Vector3d root = square.cwiseSqrt();
  Eigen::Matrix3d stretch = lame.lambda * root * root.transpose();
  stretch.diagonal() += 2 * lame.mu * square;
  return principal_values(stretch)[2];
}

}  // namespace

double max_step(Integrator integrator, double bound, double damping) {
  switch (integrator) {
    case Integrator::rk4:
      return max_step_rk4(bound, damping);
    case Integrator::semi_implicit:
      return 4 / (damping + std::hypot(damping, 2 * bound));
    case Integrator::forward_euler:
      break;
  }
  if (damping == 0) return bound == 0 ? std::numeric_limits<double>::infinity() : 0;
  return std::min(damping / (bound * bound), 2 / damping);
}

/// The strain energy depends on the displacement gradient F alone, and the sum over corners of u_j^2 that
/// gives a certain F is least tr(F G^-1 F^T), G = sum g_j g_j^T. In the principal axes of G the isotropic
/// energy couples the three F_aa with one another and each F_ab with F_ba alone.
double element_frequency_squared(const TetGradients& tet, const Lame& lame, double density) {
  const Eigen::Vector3d square = principal_gram(tet);
  const double shear = lame.mu * (square[1] + square[2]);
  return kRounding * 4 * std::max(largest_stretch(square, lame), shear) / density;
}

/// With a turn's stiffness c the energy of F_ab and F_ba is (mu + c/2)/2 (F_ab^2 + F_ba^2) + (mu - c/2) F_ab F_ba.
double averaged_frequency_squared(const TetGradients& tet, const Lame& lame, double stabilisation, double density) {
  const Eigen::Vector3d square = principal_gram(tet);
  const bool given_back = 3 * lame.lambda + 2 * lame.mu >= stabilisation;
  const double own = lame.mu + 0.5 * stabilisation, mixed = lame.mu - 0.5 * stabilisation;
  const double shear = 0.5 * (own * (square[1] + square[2]) +
                              std::hypot(own * (square[2] - square[1]), 2 * mixed * std::sqrt(square[1] * square[2])));
  const double rest = given_back ? 0 : stabilisation * square[2];
  return kRounding * 4 * (std::max(largest_stretch(square, lame), shear) + rest) / density;
}

}  // namespace palpate
