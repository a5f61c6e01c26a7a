#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "common/models/modal_shell/modal_newmark.hpp"
#include "common/shell/condensation.hpp"
#include "common/shell/full_newmark.hpp"
#include "tests/shell/modal_shells.hpp"

namespace palpate {
namespace {

using Eigen::VectorXd;
using std::numbers::pi;
using namespace testing;

/// A load without jumps, another one for each mode [N kg^-1/2].
double smooth_load(int mode, double t) {
  return std::sin(300 * t + mode) + 0.5 * std::cos(40 * t * (mode + 1)) - 1;
}

const std::vector<double> kOmega{0, 12, 150, 900, 5000, 2e5};

TEST(Newmark, TheTrapezoidalFormEqualsAppendixBUnderTheMeanForceOfEachStep) {
  const double h = 1e-3;
  const int r = static_cast<int>(kOmega.size());
  for (const auto& damping :
       {modal_damping(kOmega, 0, 0), modal_damping(kOmega, 0.2, 0), modal_damping(kOmega, 0.2, 30)}) {
    const auto constants = make_modal_constants(kOmega, damping, h);
    ModalNewmark literal(kOmega, damping, h);
    std::vector<double> x(r, 0.01), v(r, -0.5), y(r), f0(r), f1(r), mean(r);
    for (int i = 0; i < r; ++i) f0[i] = smooth_load(i, 0);
    literal.start(x, v, f0);
    for (int step = 1; step <= 1000; ++step) {
      for (int i = 0; i < r; ++i) {
        f1[i] = smooth_load(i, step * h);
        mean[i] = (f0[i] + f1[i]) / 2;
      }
      f0 = f1;
      literal.step(f1);
      free_motion(constants, x.data(), v.data(), mean.data(), y.data());
      advance(constants, x.data(), v.data(), y.data());
      for (int i = 0; i < r; ++i) {
        ASSERT_NEAR(x[i], literal.position()[i], 1e-12 * (1 + std::abs(x[i]))) << "mode " << i << " step " << step;
        ASSERT_NEAR(v[i], literal.velocity()[i], 1e-9 * (1 + std::abs(v[i]))) << "mode " << i << " step " << step;
      }
    }
  }
}

TEST(Newmark, AForceHeldOverTheStepChangesTheMotionByTheConstantsInverse) {
  const auto damping = modal_damping(kOmega, 0.1, 0);
  const auto constants = make_modal_constants(kOmega, damping, 1e-3);
  const int r = constants.modes();
  std::vector<double> x(r, 0.02), v(r, 0.3), none(r, 0), f(r, 2.5), y0(r), y1(r);
  free_motion(constants, x.data(), v.data(), none.data(), y0.data());
  free_motion(constants, x.data(), v.data(), f.data(), y1.data());
  for (int i = 0; i < r; ++i) EXPECT_NEAR(y1[i] - y0[i], 2.5 * constants.inverse[i], 1e-15);
}

/// x'' + d x' + w^2 x = f from rest.
double step_response(double w, double d, double f, double t) {
  const double decay = d / 2, turn = std::sqrt(w * w - decay * decay);
  return f / (w * w) * (1 - std::exp(-decay * t) * (std::cos(turn * t) + decay / turn * std::sin(turn * t)));
}

double step_error(double w, double d, double h, double end) {
  const std::vector<double> omega{w}, damping{d}, force{3};
  const auto constants = make_modal_constants(omega, damping, h);
  double x = 0, v = 0, y = 0, error = 0;
  for (int i = 1; i <= std::lround(end / h); ++i) {
    free_motion(constants, &x, &v, force.data(), &y);
    advance(constants, &x, &v, &y);
    error = std::max(error, std::abs(x - step_response(w, d, 3, i * h)));
  }
  return error;
}

TEST(Newmark, TheStepResponseConvergesWithTheSquareOfTheStep) {
  for (double d : {0.0, 8.0, 40.0}) {
    const double coarse = step_error(50, d, 1e-3, 0.5), fine = step_error(50, d, 5e-4, 0.5);
    EXPECT_NEAR(coarse / fine, 4, 0.1) << d;
    EXPECT_LT(fine, 2e-3 * 2 * 3 / 2500) << d;
  }
}

TEST(Newmark, DampingIsARatioOfEachModeOrProportionalToMass) {
  const std::vector<double> omega{10, 200};
  EXPECT_EQ(modal_damping(omega, 0.2, 0), (std::vector<double>{4, 80}));
  EXPECT_EQ(modal_damping(omega, 0.2, 7), (std::vector<double>{7, 7}));
}

VectorXd random_vector(Eigen::Index size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  VectorXd vector(size);
  for (double& x : vector) x = uniform(random);
  return vector;
}

TEST(Newmark, TheForceReflectedByTheWholeSystemIsTheLoad) {
  const auto system = duct(8, 6);
  const int n = system.translations();
  FullNewmark newmark(system.stiffness, system.mass, 15, 1e-3);
  const VectorXd load = 1e-3 * random_vector(n, 1);
  newmark.start(1e-4 * random_vector(n, 2), 1e-2 * random_vector(n, 3), load);
  EXPECT_LT((newmark.force() - load).norm(), 1e-9 * load.norm());
  for (int i = 1; i <= 100; ++i) {
    const VectorXd f = std::cos(0.1 * i) * load;
    newmark.step(f);
    EXPECT_LT((newmark.force() - f).norm(), 1e-7 * load.norm()) << i;
  }
}

TEST(Newmark, SparseWithRotationsAndDenseCondensedAreOneSystem) {
  const auto system = duct(8, 6);
  const int n = system.translations();
  FullNewmark sparse(system.stiffness, system.mass, 15, 1e-3);
  FullNewmark dense(condense_rotations(system.stiffness, n), system.mass, 15, 1e-3);
  const VectorXd u = 1e-4 * random_vector(n, 2), v = 1e-2 * random_vector(n, 3), load = 1e-3 * random_vector(n, 1);
  sparse.start(u, v, load);
  dense.start(u, v, load);
  EXPECT_LT((sparse.acceleration() - dense.acceleration()).norm(), 1e-9 * dense.acceleration().norm());
  double largest = 0;
  for (int i = 1; i <= 500; ++i) {
    const VectorXd f = std::cos(0.1 * i) * load;
    sparse.step(f);
    dense.step(f);
    largest = std::max(largest, dense.displacement().norm());
    ASSERT_LT((sparse.displacement() - dense.displacement()).norm(), 1e-9 * largest) << i;
  }
}

TEST(Newmark, FreeMotionWithoutDampingKeepsItsEnergyAtAnyStep) {
  const auto system = duct(8, 6);
  const int n = system.translations();
  for (double h : {1e-5, 1e-3, 1e-1, 10.0}) {
    FullNewmark newmark(system.stiffness, system.mass, 0, h);
    newmark.start(1e-4 * random_vector(n, 2), 1e-2 * random_vector(n, 3), VectorXd::Zero(n));
    const double before = newmark.energy();
    for (int i = 0; i < 1000; ++i) newmark.step(VectorXd::Zero(n));
    EXPECT_NEAR(newmark.energy(), before, 1e-6 * before) << h;
  }
}

}  // namespace
}  // namespace palpate
