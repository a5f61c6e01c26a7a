#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/models/modal_shell/modal_newmark.hpp"
#include "common/shell/full_newmark.hpp"
#include "common/shell/modes.hpp"
#include "tests/shell/modal_shells.hpp"

namespace palpate {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;
using namespace testing;

std::span<const double> view(const VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

VectorXd vector_of(std::span<const double> v) {
  return Eigen::Map<const VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
}

/// A push of 20 mN on one translation that sets in softly and swings [N].
VectorXd push(const ShellSystem& system, int dof, double t) {
  VectorXd f = VectorXd::Zero(system.translations());
  f[dof] = 0.02 * (1 - std::cos(200 * t)) * std::cos(31 * t);
  return f;
}

// A plate under a pressure that sets in at once, Navier's series in each mode's time:
// w = sum 16 p / (pi^2 m n rho t omega^2) sin sin (1 - cos omega t), m, n odd, omega of Kirchhoff's plate.
double plate_centre(double pressure, double t) {
  const double rigidity = kSteel.young * std::pow(kSteel.thickness, 3) / 12 / (1 - kSteel.poisson * kSteel.poisson);
  const double area_mass = kSteel.density * kSteel.thickness;
  double w = 0;
  for (int m = 1; m < 40; m += 2)
    for (int n = 1; n < 40; n += 2) {
      const double omega = pi * pi / (kSide * kSide) * (m * m + n * n) * std::sqrt(rigidity / area_mass);
      w += 16 * pressure / (pi * pi * m * n * area_mass * omega * omega) * std::sin(m * pi / 2) * std::sin(n * pi / 2) *
           (1 - std::cos(omega * t));
    }
  return w;
}

TEST(ModalReduction, APlateUnderASuddenPressureFollowsItsModalSeries) {
  const int cells = 24;
  const auto system = supported_plate(cells);
  const double pressure = 100, h = 1e-3;
  const double node_area = kSteel.density * kSteel.thickness;
  const VectorXd force = pressure / node_area * system.mass;  // every free translation is along z
  const int centre = system.dofs.index(cells / 2 * (cells + 1) + cells / 2, 2);
  for (int r : {30, system.translations()}) {
    const auto modes = lowest_modes(system.stiffness, system.mass, r);
    ModalNewmark newmark(view(modes.omega), modal_damping(view(modes.omega), 0, 0), h);
    const VectorXd f = modes.shape.transpose() * force, none = VectorXd::Zero(r);
    newmark.start(view(none), view(none), view(f));
    double largest = 0, error = 0;
    for (int i = 1; i <= 1000; ++i) {
      newmark.step(view(f));
      const double w = plate_centre(pressure, i * h);
      largest = std::max(largest, w);
      error = std::max(error, std::abs(modes.shape.row(centre) * vector_of(newmark.position()) - w));
    }
    EXPECT_LT(error, 0.02 * largest) << r;
  }
}

TEST(ModalReduction, AllModesEqualTheUnreducedSystemOverManySteps) {
  const auto system = duct(12, 10);
  const int n = system.translations(), dof = n - 7;
  const auto modes = lowest_modes(system.stiffness, system.mass, n);
  const double damping = 12, h = 1e-3;
  ModalNewmark reduced(view(modes.omega), modal_damping(view(modes.omega), 0.3, damping), h);
  FullNewmark full(system.stiffness, system.mass, damping, h);

  const VectorXd none = VectorXd::Zero(n), u = static_solution(system, push(system, 40, 0.01));
  const VectorXd x = modes.shape.transpose() * system.mass.cwiseProduct(u);
  full.start(u, none, push(system, dof, 0));
  reduced.start(view(x), view(none), view(none));
  double largest = 0, error = 0;
  for (int i = 1; i <= 3000; ++i) {
    const VectorXd f = push(system, dof, i * h);
    full.step(f);
    reduced.step(view(modes.shape.transpose() * f));
    largest = std::max(largest, full.displacement().norm());
    error = std::max(error, (modes.shape * vector_of(reduced.position()) - full.displacement()).norm());
  }
  EXPECT_GT(largest, 1e-4);
  EXPECT_LT(error, 1e-9 * largest);
}

TEST(ModalReduction, TheInitialModalStateIsPhiTMU) {
  const auto system = duct(12, 10);
  const auto modes = lowest_modes(system.stiffness, system.mass, 12);
  const VectorXd coordinates = VectorXd::LinSpaced(12, -1e-4, 2e-4), u = modes.shape * coordinates;
  const VectorXd x = modes.shape.transpose() * system.mass.cwiseProduct(u);
  EXPECT_LT((x - coordinates).norm(), 1e-12 * coordinates.norm());
  EXPECT_GT((modes.shape.transpose() * u - coordinates).norm(),
            coordinates.norm());  // without the mass, as printed
}

TEST(ModalReduction, ForcesOfTheModesAreMPhiFAndAPointLoadIsMostlyLost) {
  const auto system = duct(12, 10);
  const int n = system.translations();
  const auto all = lowest_modes(system.stiffness, system.mass, n);
  VectorXd load = VectorXd::Zero(n);
  load[n - 7] = 1;
  const MatrixXd mass_shape = system.mass.asDiagonal() * all.shape;
  EXPECT_LT((mass_shape * (all.shape.transpose() * load) - load).norm(), 1e-10);
  for (int r : {5, 20, 50}) {
    const VectorXd returned = mass_shape.leftCols(r) * (all.shape.leftCols(r).transpose() * load);
    EXPECT_LT(returned[n - 7], 6.0 * r / n) << r;
  }
  double mean = 0;  // over all places of the load it is r/n exactly
  for (int i = 0; i < n; ++i) mean += mass_shape.row(i).head(20).dot(all.shape.row(i).head(20)) / n;
  EXPECT_NEAR(mean, 20.0 / n, 1e-10);
}

TEST(ModalReduction, ResidualFlexibilityRestoresTheStaticAnswerToAPointLoad) {
  const auto system = duct(12, 10);
  const int n = system.translations(), dof = n - 7;
  VectorXd load = VectorXd::Zero(n);
  load[dof] = 0.05;
  const VectorXd expected = static_solution(system, load), column = expected / 0.05;
  for (int r : {1, 5, 20, 50}) {
    const auto modes = lowest_modes(system.stiffness, system.mass, r);
    const VectorXd soft = modes.omega.cwiseAbs2().cwiseInverse();
    // Integrated until it rests, not taken from the same formula.
    const auto constants = make_modal_constants(view(modes.omega), modal_damping(view(modes.omega), 0.7, 0), 2e-3);
    const VectorXd f = modes.shape.transpose() * load;
    VectorXd x = VectorXd::Zero(r), v = x, y = x;
    for (int i = 0; i < 3000; ++i) {
      free_motion(constants, x.data(), v.data(), f.data(), y.data());
      advance(constants, x.data(), v.data(), y.data());
    }
    const VectorXd truncated = modes.shape * x;
    const VectorXd residual = column - modes.shape * soft.cwiseProduct(modes.shape.row(dof).transpose());
    const VectorXd whole = truncated + 0.05 * residual;
    EXPECT_LT((whole - expected).norm(), 1e-9 * expected.norm()) << r;
    EXPECT_LT(truncated[dof], expected[dof]) << "the kept modes alone are too stiff";
    EXPECT_GT(residual[dof], 0);
  }
}

}  // namespace
}  // namespace palpate
