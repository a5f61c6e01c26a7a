#include <gtest/gtest.h>

#include "common/fem/fine_element.hpp"
#include "common/fem/fine_problem.hpp"
#include "common/fem/hat_tractions.hpp"
#include "tests/fem/meshes_for_tests.hpp"
#include "tests/reference/loads.hpp"

/// What the offline discretisations must carry exactly, and how fast they approach the rest. Bodies are held at three
/// corners so that nothing but the tractions strains them.
namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

QuasiStaticSpec determinate(double young, double poisson, int cells) {
  const int n = cells + 1;
  auto body = testing::make_body(young, poisson);
  body.fixed = {testing::fix_nodes({0}), testing::fix_nodes({cells}, {false, true, true}),
                testing::fix_nodes({n * cells}, {false, false, true})};
  return body;
}

/// Displacement gradient of a uniform stress on a cube that determinate() holds: what would turn the held corners is
/// zero.
Matrix3d determinate_gradient(const Matrix3d& stress, double young, double poisson) {
  const Matrix3d strain = ((1 + poisson) * stress - poisson * stress.trace() * Matrix3d::Identity()) / young;
  Matrix3d gradient = 2 * strain.triangularView<Eigen::StrictlyUpper>().toDenseMatrix();
  gradient.diagonal() = strain.diagonal();
  return gradient;
}

const std::vector<Offline> kFiner{{1, FiniteElement::p1, Formulation::displacement},
                                  {1, FiniteElement::p1, Formulation::locking_free},
                                  {0, FiniteElement::p2, Formulation::displacement},
                                  {0, FiniteElement::p2, Formulation::locking_free},
                                  {1, FiniteElement::p2, Formulation::locking_free}};

TEST(FinePatch, ConstantStressIsExactInEveryFormulationUpToIncompressibility) {
  Matrix3d stress = Matrix3d::Constant(400);
  stress.diagonal().setConstant(2000);
  for (double poisson : {0.25, 0.4999, 0.4999999})
    for (const auto& offline : kFiner) {
      const auto mesh = testing::make_jittered_block({1, 1, 1}, {4, 4, 4}, 0.2);
      const auto problem = make_fine_problem(determinate(1e6, poisson, 4), mesh, offline);
      const auto load =
          traction_loads(problem.space, [&](const auto&, const auto& n) -> Vector3d { return stress * n; });
      const auto u = solve_fine_loads(problem, load);
      const Eigen::VectorXd pressure = problem.pressures ? (*problem.pressures)(u) : Eigen::VectorXd();
      double worst = 0;
      for (int e = 0; e < static_cast<int>(problem.space.elements.size()); ++e)
        for (int c = 0; c < 4; ++c) {
          const auto found = fine_stress(problem.space, problem.materials, problem.pressures ? &pressure : nullptr, u,
                                         e, Eigen::Vector4d::Unit(c));
          worst = std::max(worst, (found - stress).cwiseAbs().maxCoeff());
        }
      const Matrix3d slope = determinate_gradient(stress, 1e6, poisson);
      double furthest = 0;
      for (std::size_t i = 0; i < u.size(); ++i)
        furthest = std::max(furthest, (u[i] - slope * problem.space.nodes[i]).norm());
      EXPECT_LT(furthest, 1e-11 * slope.norm() / (1 - 2 * poisson))
          << poisson << " " << word_of(offline.element) << " " << word_of(offline.formulation);
      // Rounding in the dilatation is felt with the factor 1/(1 - 2 nu).
      EXPECT_LT(worst, 1e-9 * 2000 / (1 - 2 * poisson))
          << poisson << " " << word_of(offline.element) << " " << word_of(offline.formulation);
    }
}

/// u = grad phi / (2 mu) with phi = x^4 - 6 x^2 y^2 + y^4 + x^3 z - 3 x y^2 z harmonic: in equilibrium without body
/// force, free of dilatation, cubic; stress 2 mu grad u.
Matrix3d harmonic_stress(const Vector3d& p) {
  const double x = p.x(), y = p.y(), z = p.z();
  Matrix3d second;
  const double xx = 12 * x * x - 12 * y * y + 6 * x * z, xy = -24 * x * y - 6 * y * z, xz = 3 * x * x - 3 * y * y;
  const double yz = -6 * x * y;
  second << xx, xy, xz, xy, -xx, yz, xz, yz, 0;
  return second;
}

/// Elastic energy of the unit cube, int |stress|^2 / (4 mu), by three Gauss points an axis (exact: degree 4).
double harmonic_energy(double mu) {
  const double at[3] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)}, weight[3] = {5. / 18, 8. / 18, 5. / 18};
  double energy = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        energy += weight[i] * weight[j] * weight[k] * harmonic_stress({at[i], at[j], at[k]}).squaredNorm() / (4 * mu);
  return energy;
}

/// Error in the energy norm, relative: its square is the energy that a displacement method lacks under exact tractions.
double energy_error(const Offline& offline, double poisson, int cells) {
  const auto mesh = testing::make_jittered_block({1, 1, 1}, {cells, cells, cells}, 0.1);
  const auto problem = make_fine_problem(determinate(1, poisson, cells), mesh, offline);
  const auto load =
      traction_loads(problem.space, [](const auto& x, const auto& n) -> Vector3d { return harmonic_stress(x) * n; });
  const double energy = 0.5 * testing::work(load, solve_fine_loads(problem, load));
  return std::sqrt(std::abs(1 - energy / harmonic_energy(0.5 / (1 + poisson))));
}

TEST(FineConvergence, LinearElementsAreOfFirstAndQuadraticOnesOfSecondOrderInTheEnergyNorm) {
  const auto order = [](const Offline& offline, double poisson, int cells) {
    const double coarse = energy_error(offline, poisson, cells), fine = energy_error(offline, poisson, 2 * cells);
    std::printf("%s refine %d, nu %.2f: %.5f %.5f\n", word_of(offline.element).data(), offline.refine, poisson, coarse,
                fine);
    return testing::order(coarse, fine);
  };
  EXPECT_NEAR(order({1, FiniteElement::p1, Formulation::displacement}, 0.3, 4), 1, 0.1);
  EXPECT_NEAR(order({0, FiniteElement::p2, Formulation::displacement}, 0.3, 4), 2, 0.15);
  EXPECT_GT(order({0, FiniteElement::p2, Formulation::locking_free}, 0.45, 4), 0.9);
  EXPECT_GT(order({1, FiniteElement::p1, Formulation::locking_free}, 0.45, 4), 0.9);
}

}  // namespace
}  // namespace palpate
