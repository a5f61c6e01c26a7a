#pragma once
#include <limits>

#include "bench/exact_fields.hpp"
#include "tests/fem/meshes_for_tests.hpp"

/// The patch test of MacNeal and Harder for solids: a unit cube of irregular elements whose faces move by a
/// linear field.
namespace palpate::bench {

/// Largest errors over the largest value, in units of the rounding of a double.
struct PatchErrors {
  double displacement, stress;
  int unknowns;
};

/// Stress 2000 and 400 Pa with E = 1e6; at nu = 0.25 the field is u = 1e-3 (2x+y+z, x+2y+z, x+y+2z) / 2.
inline PatchErrors solid_patch(const Offline& offline, double poisson, unsigned seed) {
  constexpr double young = 1e6;
  Eigen::Matrix3d stress = Eigen::Matrix3d::Constant(400);
  stress.diagonal().setConstant(2000);
  const Eigen::Matrix3d strain =
      ((1 + poisson) * stress - poisson * stress.trace() * Eigen::Matrix3d::Identity()) / young;
  const auto exact = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return strain * x; };
  const auto on_face = [](const Eigen::Vector3d& x, int) { return x.minCoeff() < 1e-9 || x.maxCoeff() > 1 - 1e-9; };
  const auto mesh = palpate::testing::make_jittered_block({1, 1, 1}, {4, 4, 4}, 0.2, seed);
  const auto problem = make_held_problem(mesh, {young, poisson, 1}, offline, on_face);
  const auto& space = problem.space;
  const auto moved =
      solve_held(problem, exact, std::vector<Eigen::Vector3d>(space.nodes.size(), Eigen::Vector3d::Zero()));

  constexpr double rounding = std::numeric_limits<double>::epsilon();
  PatchErrors errors{0, 0, problem.dofs.size()};
  double largest = 0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    errors.displacement = std::max(errors.displacement, (moved[i] - exact(space.nodes[i])).cwiseAbs().maxCoeff());
    largest = std::max(largest, moved[i].cwiseAbs().maxCoeff());
  }
  errors.displacement /= largest * rounding;
  Eigen::VectorXd pressure;
  if (problem.pressures) pressure = (*problem.pressures)(moved);
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e)
    for (int c = 0; c < 4; ++c) {
      const auto found = fine_stress(space, problem.materials, pressure.size() ? &pressure : nullptr, moved, e,
                                     Eigen::Vector4d::Unit(c));
      errors.stress = std::max(errors.stress, (found - stress).cwiseAbs().maxCoeff() / (2000 * rounding));
    }
  return errors;
}

}  // namespace palpate::bench
