#include "common/fem/elasticity.hpp"

#include <gtest/gtest.h>

#include <random>

#include "common/geometry/dense_solvers.hpp"

namespace palpate {
namespace {

using Displacement = Eigen::Matrix<double, 4, 3>;
using Stiffness = Eigen::Matrix<double, 12, 12>;

const std::array<Eigen::Vector3d, 4> kVertices{Eigen::Vector3d{0.1, -0.2, 0.05}, Eigen::Vector3d{1.2, 0.1, -0.1},
                                               Eigen::Vector3d{0.3, 1.1, 0.2}, Eigen::Vector3d{0.2, 0.3, 0.9}};
const Material kMaterial{1000, 0.4, 1000};

Eigen::Matrix<double, 12, 1> as_vector(const Displacement& u) {
  Eigen::Matrix<double, 12, 1> vector;
  for (int i = 0; i < 4; ++i) vector.segment<3>(3 * i) = u.row(i);
  return vector;
}

Displacement linear_field(const Eigen::Matrix3d& gradient) {
  Displacement u;
  for (int i = 0; i < 4; ++i) u.row(i) = gradient * kVertices[i];
  return u;
}

class Elasticity : public ::testing::Test {
 protected:
  TetGradients tet = tet_gradients(kVertices);
  Lame constants = lame(kMaterial);
  Stiffness k = element_stiffness(tet, constants);
};

TEST_F(Elasticity, GradientsReproduceALinearFunction) {
  const Eigen::Vector3d slope(0.3, -1.7, 2.2);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < 4; ++i) sum += slope.dot(kVertices[i]) * tet.gradient.row(i).transpose();
  EXPECT_LT((sum - slope).norm(), 1e-13);
  EXPECT_LT(tet.gradient.colwise().sum().norm(), 1e-14);
}

TEST_F(Elasticity, StiffnessIsSymmetric) {
  EXPECT_LT((k - k.transpose()).norm(), 1e-13 * k.norm());
}

TEST_F(Elasticity, TranslationNeedsNoForce) {
  for (int axis = 0; axis < 3; ++axis) {
    Displacement u = Displacement::Zero();
    u.col(axis).setOnes();
    EXPECT_LT((k * as_vector(u)).norm(), 1e-13 * k.norm());
  }
}

TEST_F(Elasticity, InfinitesimalRotationStoresNoEnergy) {
  Eigen::Matrix3d spin;
  spin << 0, -0.3, 0.2, 0.3, 0, -0.5, -0.2, 0.5, 0;
  const Displacement u = linear_field(spin);
  EXPECT_LT(element_energy(tet, constants, u), 1e-25 * k.norm());
  EXPECT_LT((k * as_vector(u)).norm(), 1e-13 * k.norm());
}

TEST_F(Elasticity, StiffnessIsPositiveSemidefiniteWithSixZeroModes) {
  const Eigen::VectorXd eigenvalues = symmetric_eigenvalues(k);
  for (int i = 0; i < 6; ++i) EXPECT_LT(std::abs(eigenvalues[i]), 1e-13 * k.norm());
  for (int i = 6; i < 12; ++i) EXPECT_GT(eigenvalues[i], 1e-3 * k.norm());
}

TEST_F(Elasticity, TheOrderPrintedInTheReportHasNegativeEigenvalues) {
  Stiffness printed;  // RR3510 eq. 5 with its outer products as printed
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const Eigen::Vector3d gi = tet.gradient.row(i), gj = tet.gradient.row(j);
      printed.block<3, 3>(3 * i, 3 * j) =
          tet.volume * (constants.lambda * gj * gi.transpose() + constants.mu * gi * gj.transpose() +
                        constants.mu * gi.dot(gj) * Eigen::Matrix3d::Identity());
    }
  const Eigen::VectorXd eigenvalues = symmetric_eigenvalues(printed);
  EXPECT_LT(eigenvalues[0], -1e-3 * printed.norm());
}

TEST_F(Elasticity, StiffnessIsTheSecondDerivativeOfTheEnergy) {
  const double step = 1e-3;
  const auto energy = [&](int a, double da, int b, double db) {
    Displacement u = Displacement::Zero();
    u(a / 3, a % 3) += da;
    u(b / 3, b % 3) += db;
    return element_energy(tet, constants, u);
  };
  for (int a = 0; a < 12; ++a)
    for (int b = 0; b < 12; ++b) {
      const double derivative = (energy(a, step, b, step) - energy(a, step, b, -step) - energy(a, -step, b, step) +
                                 energy(a, -step, b, -step)) /
                                (4 * step * step);
      EXPECT_NEAR(derivative, k(a, b), 1e-9 * k.norm()) << a << " " << b;
    }
}

TEST_F(Elasticity, EnergyIsHalfTheWorkOfTheForces) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Displacement u = Displacement::NullaryExpr([&] { return normal(random); });
  const auto vector = as_vector(u);
  EXPECT_NEAR(element_energy(tet, constants, u), 0.5 * vector.dot(k * vector), 1e-12 * k.norm());
}

TEST_F(Elasticity, UniaxialStrainGivesTheTextbookStress) {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  gradient(0, 0) = 0.01;
  const auto stress = element_stress(tet, constants, linear_field(gradient));
  const double e = kMaterial.young, nu = kMaterial.poisson;
  EXPECT_NEAR(stress(0, 0), 0.01 * e * (1 - nu) / ((1 + nu) * (1 - 2 * nu)), 1e-10);
  EXPECT_NEAR(stress(1, 1), 0.01 * e * nu / ((1 + nu) * (1 - 2 * nu)), 1e-10);
  EXPECT_NEAR(stress(0, 1), 0, 1e-12);
}

}  // namespace
}  // namespace palpate
