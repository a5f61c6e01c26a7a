#include "common/models/catheter/chain.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "common/geometry/dense_solvers.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

Catheter shape(int particles = 12) {
  Catheter c;
  c.tail = {0, 0, 0};
  c.tip = {0.033, 0, 0};
  c.particles = particles;
  return c;
}

std::vector<Vector3d> crooked(const Chain& chain, double by) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-by, by);
  std::vector<Vector3d> x(chain.rest().begin(), chain.rest().end());
  for (Vector3d& p : x) p += Vector3d::NullaryExpr([&] { return uniform(random); });
  return x;
}

std::vector<Vector3d> forces(const Chain& chain, const std::vector<Vector3d>& x) {
  std::vector<Vector3d> f(x.size(), Vector3d::Zero());
  chain.add_forces(x, f);
  return f;
}

TEST(Chain, ForcesAreTheEnergysDerivative) {
  const Chain chain(shape(), 1e6, 1000);
  const auto x = crooked(chain, 1e-3);
  const auto f = forces(chain, x);
  double largest = 0;
  for (const Vector3d& p : f) largest = std::max(largest, p.norm());
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      auto up = x, down = x;
      up[i][axis] += 1e-8;
      down[i][axis] -= 1e-8;
      EXPECT_NEAR(f[i][axis], -(chain.elastic_energy(up) - chain.elastic_energy(down)) / 2e-8, 1e-6 * largest);
    }
}

TEST(Chain, ForcesAndMomentsCancel) {
  const Chain chain(shape(), 1e8, 1000);
  const auto x = crooked(chain, 1e-3);
  const auto f = forces(chain, x);
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
  double size = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    force += f[i];
    moment += x[i].cross(f[i]);
    size += f[i].norm();
  }
  EXPECT_LT(force.norm(), 1e-12 * size);
  EXPECT_LT(moment.norm(), 1e-12 * size * 0.033);
}

TEST(Chain, StiffnessAtRestIsTheForcesDerivative) {
  const Chain chain(shape(), 1e6, 1000);
  const std::vector<Vector3d> x(chain.rest().begin(), chain.rest().end());
  const int n = 3 * chain.size();
  BandMatrix k(chain.size());
  chain.add_stiffness(x, std::vector<double>(chain.size() - 1, 0.0), k);
  for (int i = 0; i < chain.size(); ++i) k.add(i, 0, Eigen::Matrix3d::Identity());
  ASSERT_TRUE(k.factorise());
  // With K' the numerical derivative, (K + I)^-1 (K' + I) is the identity.
  for (int j = 0; j < n; ++j) {
    auto up = x, down = x;
    up[j / 3][j % 3] += 1e-7;
    down[j / 3][j % 3] -= 1e-7;
    const auto fu = forces(chain, up), fd = forces(chain, down);
    std::vector<double> column(n + BandMatrix::kBand);
    for (int i = 0; i < n; ++i) column[i] = -(fu[i / 3][i % 3] - fd[i / 3][i % 3]) / 2e-7 + (i == j);
    k.solve(column);
    for (int i = 0; i < n; ++i) EXPECT_NEAR(column[i], i == j, 1e-5);
  }
}

TEST(Chain, NoFrequencyLiesAboveTheBound) {
  const Chain chain(shape(20), 3e6, 1200);
  const int n = 3 * chain.size();
  const std::vector<Vector3d> x(chain.rest().begin(), chain.rest().end());
  Eigen::MatrixXd k(n, n);
  for (int j = 0; j < n; ++j) {
    auto up = x, down = x;
    up[j / 3][j % 3] += 1e-7;
    down[j / 3][j % 3] -= 1e-7;
    const auto fu = forces(chain, up), fd = forces(chain, down);
    for (int i = 0; i < n; ++i)
      k(i, j) = -(fu[i / 3][i % 3] - fd[i / 3][i % 3]) / 2e-7 / std::sqrt(chain.mass()[i / 3] * chain.mass()[j / 3]);
  }
  const double largest = std::sqrt(symmetric_eigenvalues(0.5 * (k + k.transpose())).maxCoeff());
  EXPECT_LE(largest, chain.frequency_bound());
  EXPECT_GT(largest, 0.7 * chain.frequency_bound());
}

TEST(Chain, RefusesNumbersOutOfRange) {
  Catheter c = shape();
  EXPECT_THROW(Chain(c, 0, 1000), std::runtime_error);
  EXPECT_THROW(Chain(c, 1e6, -1), std::runtime_error);
  c.particles = 2;
  EXPECT_THROW(Chain(c, 1e6, 1000), std::runtime_error);
  c = shape();
  c.tip = c.tail;
  EXPECT_THROW(Chain(c, 1e6, 1000), std::runtime_error);
}

}  // namespace
}  // namespace palpate
