#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/dynamics/tensor_mass.hpp"
#include "common/geometry/dense_solvers.hpp"
#include "tests/dynamics/dynamic_meshes.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Field = std::vector<Vector3d>;

/// Free vibration by the assembled matrix: angular frequencies [rad/s], ascending, and shapes over all nodes.
struct Modes {
  explicit Modes(const testing::DynamicBody& body) {
    const auto& dofs = body.problem.dofs;
    const TensorMass<double> lumped(body.mesh, Integrator::rk4, 0);
    const Eigen::MatrixXd lower = assemble_stiffness(body.problem.mesh, body.problem.materials, dofs);
    Eigen::VectorXd mass(dofs.size());
    for (int i = 0; i < dofs.size(); ++i) mass[i] = lumped.mass(dofs.dof(i) / 3);
    // K x = w^2 M x by the eigenvectors y = M^1/2 x of M^-1/2 K M^-1/2.
    const Eigen::VectorXd to_shape = mass.cwiseSqrt().cwiseInverse();
    const auto [square, vector] = symmetric_eigen(to_shape.asDiagonal() * lower * to_shape.asDiagonal());
    frequency = square.cwiseSqrt();
    for (int k : {0, 1, 2, 3, 4}) {
      shape.emplace_back(body.mesh.rest.size(), Vector3d::Zero());
      for (int i = 0; i < dofs.size(); ++i)
        shape[k][dofs.dof(i) / 3][dofs.dof(i) % 3] = 1e-4 * to_shape[i] * vector(i, k);
    }
  }
  double highest() const { return frequency[frequency.size() - 1]; }

  Eigen::VectorXd frequency;
  std::vector<Field> shape;  // the lowest ones
};

void displace(DynamicModel& model, const Field& u) {
  for (int n = 0; n < model.nodes(); ++n) model.set_motion(n, u[n], Vector3d::Zero());
}

/// How much of a mode is in the present displacement.
double amplitude(const DynamicModel& model, const Field& shape) {
  double sum = 0;
  for (int n = 0; n < model.nodes(); ++n) sum += model.mass(n) * model.displacement(n).dot(shape[n]);
  return sum;
}

/// Time [s] from one falling zero of the mode's amplitude to the next, between steps by a straight line.
double measured_period(DynamicModel& model, const Field& shape, double h) {
  std::vector<double> zeros;
  double before = amplitude(model, shape);
  for (int i = 0; zeros.size() < 2; ++i) {
    model.step(h);
    const double now = amplitude(model, shape);
    if (before > 0 && now <= 0) zeros.push_back(h * (i + before / (before - now)));
    before = now;
  }
  return zeros[1] - zeros[0];
}

TEST(Vibration, LowestFrequenciesAreThoseOfTheEigenproblem) {
  const auto body = testing::dynamic_block({4, 3, 5});
  const Modes modes(body);
  for (Integrator integrator : {Integrator::rk4, Integrator::semi_implicit})
    for (int k : {0, 1, 2, 3, 4}) {
      TensorMass<double> model(body.mesh, integrator, 0);
      displace(model, modes.shape[k]);
      const double h = 0.1 * max_step(integrator, model.frequency_bound(), 0);
      const double period = measured_period(model, modes.shape[k], h);
      EXPECT_NEAR(period * modes.frequency[k] / (2 * std::numbers::pi), 1, 1e-4) << "mode " << k;
    }
}

TEST(Vibration, ABarSwingsAtItsClosedFormFrequency) {
  const int cells = 24;
  TetMesh tets = make_block({0, 0, 0}, {0.01, 0.01, 0.01 * cells}, {1, 1, cells});
  const auto body = testing::make_dynamic(tets, {4e3, 0, 1000},
                                          {testing::fix_group("bottom"), testing::fix_group("x0", {true, true, false}),
                                           testing::fix_group("x1", {true, true, false})});
  TensorMass<float> model(body.mesh, Integrator::rk4, 0);
  const double length = 0.01 * cells, wave = std::numbers::pi / (2 * length);
  Field shape;
  for (const Vector3d& x : body.mesh.rest) shape.emplace_back(0, 0, 1e-3 * std::sin(wave * x.z()));
  displace(model, shape);
  const double frequency = wave * std::sqrt(4e3 / 1000);
  const double period = measured_period(model, shape, 0.1 * max_step(Integrator::rk4, model.frequency_bound(), 0));
  EXPECT_NEAR(period * frequency / (2 * std::numbers::pi), 1, 1e-3);
}

/// Largest relative change of energy within a time of free vibration.
double energy_change(const testing::DynamicBody& body, const Field& start, Integrator integrator, double h,
                     double time) {
  TensorMass<double> model(body.mesh, integrator, 0);
  displace(model, start);
  const double before = model.energy();
  double largest = 0;
  for (int i = 0; i < std::lround(time / h); ++i) {
    model.step(h);
    if (integrator != Integrator::rk4 || i + 1 == std::lround(time / h))
      largest = std::max(largest, std::abs(model.energy() / before - 1));
  }
  return largest;
}

TEST(Vibration, Rk4LosesEnergyAtTheFifthPowerOfTheStep) {
  const auto body = testing::dynamic_block({3, 3, 3});
  const auto start = testing::random_field(body.mesh.rest.size(), 1e-4, 4);
  const double h =
      max_step(Integrator::rk4, TensorMass<double>(body.mesh, Integrator::rk4, 0).frequency_bound(), 0) / 8;
  const double coarse = energy_change(body, start, Integrator::rk4, h, 256 * h);
  const double fine = energy_change(body, start, Integrator::rk4, h / 2, 256 * h);
  EXPECT_LT(coarse, 2e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 5, 0.1);
}

TEST(Vibration, SemiImplicitEnergySwingsWithTheStepAndDoesNotDrift) {
  const auto body = testing::dynamic_block({3, 3, 3});
  const auto start = testing::random_field(body.mesh.rest.size(), 1e-4, 4);
  const double bound = TensorMass<double>(body.mesh, Integrator::rk4, 0).frequency_bound();
  const double h = max_step(Integrator::semi_implicit, bound, 0) / 16;
  const double coarse = energy_change(body, start, Integrator::semi_implicit, h, 512 * h);
  const double fine = energy_change(body, start, Integrator::semi_implicit, h / 2, 512 * h);
  const double longer = energy_change(body, start, Integrator::semi_implicit, h, 4096 * h);
  EXPECT_NEAR(std::log2(coarse / fine), 1, 0.1);
  EXPECT_LT(longer, 1.5 * coarse);
}

/// Growth of the energy over many steps from a random start.
double growth(const testing::DynamicBody& body, Integrator integrator, double damping, double h) {
  TensorMass<double> model(body.mesh, integrator, damping);
  displace(model, testing::random_field(body.mesh.rest.size(), 1e-4, 4));
  const double before = model.energy();
  for (int i = 0; i < 6000; ++i) model.step(h);
  return model.energy() / before;
}

TEST(Vibration, TheLargestStepOfTheTrueFrequencyDividesBoundedFromGrowingMotion) {
  const auto body = testing::dynamic_block({3, 3, 3});
  const double highest = Modes(body).highest();
  for (double damping : {0.0, 300.0, 0.5 * highest})
    for (Integrator integrator : {Integrator::rk4, Integrator::semi_implicit, Integrator::forward_euler}) {
      const double h = max_step(integrator, highest, damping);
      if (h == 0) continue;
      EXPECT_LT(growth(body, integrator, damping, 0.99 * h), 20) << static_cast<int>(integrator) << ", " << damping;
      // Forward Euler with a small step grows slowly.
      const double beyond = integrator == Integrator::forward_euler && damping < 0.3 * highest ? 1.5 : 1.01;
      EXPECT_FALSE(growth(body, integrator, damping, beyond * h) < 1e3)
          << static_cast<int>(integrator) << ", " << damping;
    }
}

TEST(Vibration, TheBoundLiesAboveTheHighestFrequency) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const double jitter = seed % 2 ? 0.1 : 0.3, poisson = seed % 3 ? 0.45 : 0.1, flatness = seed % 4 ? 1 : 0.05;
    const auto tets = testing::make_jittered_block({0.03, 0.04, 0.03 * flatness}, {3, 4, 3}, jitter, seed);
    const auto body = testing::make_dynamic(tets, {3e3, poisson, 1000}, {testing::fix_group("bottom")});
    const double bound = TensorMass<float>(body.mesh, Integrator::rk4, 0).frequency_bound();
    const double highest = Modes(body).highest();
    EXPECT_GE(bound, highest);
    EXPECT_LT(bound, (flatness < 1 ? 12 : 4) * highest);  // a sliver's corners carry others' mass too
  }
}

TEST(Vibration, TheBoundedStepKeepsTheBodyStable) {
  const auto body = testing::dynamic_block({3, 3, 3});
  const double bound = TensorMass<float>(body.mesh, Integrator::rk4, 0).frequency_bound();
  for (Integrator integrator : {Integrator::rk4, Integrator::semi_implicit})
    EXPECT_LT(growth(body, integrator, 0, 0.99 * max_step(integrator, bound, 0)), 20);
}

}  // namespace
}  // namespace palpate
