#include "bench/half_space.hpp"

#include <gtest/gtest.h>

#include "tests/fem/meshes_for_tests.hpp"
#include "tests/reference/loads.hpp"

/// Kelvin, Boussinesq and the disc under uniform pressure on coarse meshes; docs/verification.md has the fine
/// ones.
namespace palpate {
namespace {

using namespace bench;

const Offline kP1{}, kP2{0, FiniteElement::p2, Formulation::displacement},
    kFree{0, FiniteElement::p2, Formulation::locking_free};

/// Errors halfway to the far faces, ahead of the force and beside it.
std::array<double, 2> halfway(int n, const Offline& offline, bool in_infinite_body) {
  const auto found = point_force(n, offline, 0.3, in_infinite_body);
  const int half = n / 2 - 1;
  return {std::abs(found.ahead[half] / found.exact_ahead[half] - 1),
          std::abs(found.beside[half] / found.exact_beside[half] - 1)};
}

TEST(HalfSpace, ClosedFormsAreInEquilibriumAndTheDiscTendsToThePoint) {
  const double step = 1e-4, poisson = 0.3, shear = 0.5 / (1 + poisson);
  const Vector3d at(0.3, 0.2, 0.4);
  for (const auto& field : {kelvin, boussinesq, pressed_disc}) {
    // Navier: mu lap u + (lambda + mu) grad div u = 0, by central differences.
    Vector3d laplace = Vector3d::Zero(), slope = Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
      const Vector3d d = step * Vector3d::Unit(i);
      laplace += (field(at + d, poisson) - 2 * field(at, poisson) + field(at - d, poisson)) / (step * step);
      for (int j = 0; j < 3; ++j) {
        const Vector3d e = step * Vector3d::Unit(j);
        slope[i] += ((field(at + d + e, poisson) - field(at + d - e, poisson)) -
                     (field(at - d + e, poisson) - field(at - d - e, poisson)))[j] /
                    (4 * step * step);
      }
    }
    EXPECT_LT((shear * laplace + shear / (1 - 2 * poisson) * slope).norm(), 1e-5);
  }
  EXPECT_NEAR(boussinesq({0.5, 0, 0}, poisson).z(), (1 - poisson) / (2 * M_PI * shear * 0.5), 1e-12);
  const Vector3d far(30, 0, 40);
  EXPECT_LT((pressed_disc(far, poisson) - boussinesq(far, poisson)).norm(), 1e-4 * boussinesq(far, poisson).norm());
}

TEST(HalfSpace, PointForcesAreRightAFewElementsAway) {
  for (const bool infinite : {true, false}) {
    const auto coarse = halfway(4, kP2, infinite), fine = halfway(8, kP2, infinite), linear = halfway(8, kP1, infinite);
    for (int i = 0; i < 2; ++i) {
      EXPECT_LT(fine[i], 0.01);
      EXPECT_GT(testing::order(coarse[i], fine[i]), 2);
      EXPECT_LT(linear[i], 0.1);
    }
  }
}

TEST(HalfSpace, MeanDisplacementOfAPressedDiscIsWithinTwoPercentAtTwoElementsToItsRadius) {
  const auto mesh = testing::make_jittered_block({1, 1, 1}, {8, 8, 8}, 0.2);
  for (double poisson : {0.3, 0.4999}) {
    const double exact = pressed_disc_mean(poisson);
    EXPECT_NEAR(solve_disc(mesh, kFree, poisson).value, exact, 0.01 * exact);
    EXPECT_NEAR(solve_disc(mesh, kP2, poisson).value, exact, 0.025 * exact);
    EXPECT_LT(solve_disc(mesh, kP1, poisson).value, (poisson > 0.4 ? 0.7 : 0.95) * exact)
        << "linear elements are too stiff";
  }
}

}  // namespace
}  // namespace palpate
