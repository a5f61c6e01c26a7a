#include "common/dynamics/stability.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>

#include "common/geometry/dense_solvers.hpp"

namespace palpate {
namespace {

/// Growth per step of the mode with angular frequency w.
double growth(Integrator integrator, double w, double a, double h) {
  using Complex = std::complex<double>;
  if (integrator == Integrator::semi_implicit) {  // roots of z^2 - (2 - a h - h^2 w^2) z + (1 - a h)
    const double s = 0.5 * (a * h + h * h * w * w);
    const Complex root = std::sqrt(Complex(s * s - h * h * w * w));
    return std::max(std::abs(1 - s + root), std::abs(1 - s - root));
  }
  const Complex root = std::sqrt(Complex(0.25 * a * a - w * w));
  double largest = 0;
  for (const Complex z : {h * (-0.5 * a + root), h * (-0.5 * a - root)}) {
    Complex sum = 1, term = 1;
    for (int k = 1; k <= (integrator == Integrator::rk4 ? 4 : 1); ++k) sum += term *= z / double(k);
    largest = std::max(largest, std::abs(sum));
  }
  return largest;
}

/// The largest growth over all frequencies up to the bound.
double worst_growth(Integrator integrator, double bound, double a, double h) {
  double worst = 0;
  for (int i = 0; i <= 4000; ++i) worst = std::max(worst, growth(integrator, bound * i / 4000, a, h));
  return worst;
}

constexpr std::array kIntegrators{Integrator::rk4, Integrator::semi_implicit, Integrator::forward_euler};

TEST(LargestStep, IsTheKnownOneWithoutDamping) {
  EXPECT_DOUBLE_EQ(max_step(Integrator::rk4, 500, 0), 2 * std::sqrt(2.0) / 500);
  EXPECT_DOUBLE_EQ(max_step(Integrator::semi_implicit, 500, 0), 2.0 / 500);
  EXPECT_EQ(max_step(Integrator::forward_euler, 500, 0), 0);
}

TEST(LargestStep, KeepsEveryFrequencyUpToTheBoundFromGrowing) {
  for (Integrator integrator : kIntegrators)
    for (double damping : {0.01, 1.0, 30.0, 200.0, 999.0, 1000.0, 1001.0, 1999.0, 2001.0, 5000.0, 1e5}) {
      const double h = max_step(integrator, 1000, damping);
      for (double share : {0.05, 0.3, 0.6, 0.8, 0.9, 0.97, 0.999999})
        EXPECT_LE(worst_growth(integrator, 1000, damping, share * h), 1 + 1e-12)
            << "integrator " << static_cast<int>(integrator) << ", damping " << damping << ", share " << share;
    }
}

TEST(LargestStep, IsTheLargest) {
  for (Integrator integrator : kIntegrators)
    for (double damping : {1.0, 30.0, 200.0, 999.0, 1001.0, 1999.0, 2001.0, 5000.0, 1e5}) {
      const double h = max_step(integrator, 1000, damping);
      EXPECT_GT(worst_growth(integrator, 1000, damping, 1.001 * h), 1 + 1e-10)
          << "integrator " << static_cast<int>(integrator) << ", damping " << damping;
    }
}

/// Corners at random; some are slivers, needles and caps.
std::array<Eigen::Vector3d, 4> random_tetrahedron(std::mt19937& random, double flatness) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::array<Eigen::Vector3d, 4> x;
  do {
    for (auto& p : x) p = {uniform(random), uniform(random), flatness * uniform(random)};
  } while (tet_gradients(x).volume <= 1e-6 * flatness);
  return x;
}

TEST(ElementFrequency, IsTheLargestEigenvalueOfTheElement) {
  std::mt19937 random(7);
  for (double poisson : {-0.5, 0.0, 0.3, 0.45, 0.499})
    for (double flatness : {1.0, 0.1, 1e-3})
      for (int i = 0; i < 50; ++i) {
        const auto tet = tet_gradients(random_tetrahedron(random, flatness));
        const Material material{2e3, poisson, 1100};
        const auto k = element_stiffness(tet, lame(material));
        const double largest = symmetric_eigenvalues(k).maxCoeff();
        const double exact = 4 * largest / (1100 * tet.volume);
        EXPECT_NEAR(element_frequency_squared(tet, lame(material), 1100) / exact, 1, 1e-9);
      }
}

}  // namespace
}  // namespace palpate
