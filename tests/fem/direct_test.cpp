#include "common/fem/direct.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "common/geometry/dense_solvers.hpp"
#include "common/mesh/surface.hpp"
#include "tests/fem/meshes_for_tests.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::relative_difference;

/// TVCG99 eq. 14 by another library: [K J^T; J 0] [u; lambda] = [0; d] over all dofs, with one multiplier per
/// fixed and per held dof. lambda is minus the force on the tissue.
StaticSolution solve_augmented(const StaticProblem& problem, const std::vector<Constraint>& constraints) {
  const DofMap all(problem.mesh);
  std::vector<Constraint> rows = constraints;
  for (int node = 0; node < problem.dofs.nodes(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (problem.dofs.index(node, axis) == DofMap::kFixed) rows.push_back(hold(node, axis, 0));
  const auto stiffness = assemble_stiffness(problem.mesh, problem.materials, all);
  const int n = all.size(), m = static_cast<int>(rows.size());
  // Multipliers are scaled to the size of the stiffness, so that the pivots are comparable.
  const double scale = stiffness.coeffs().abs().maxCoeff();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + m, n + m);
  for (int c = 0; c < n; ++c)
    for (SparseMatrix::InnerIterator it(stiffness, c); it; ++it) matrix(it.row(), c) = matrix(c, it.row()) = it.value();
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n + m);
  for (int r = 0; r < m; ++r) {
    right[n + r] = scale * rows[r].value;
    for (const auto& [node, axis, weight] : rows[r].terms) {
      const int dof = all.index(node, axis);
      matrix(n + r, dof) += scale * weight;
      matrix(dof, n + r) += scale * weight;
    }
  }
  const Eigen::VectorXd x = solve_general(matrix, right);

  StaticSolution solution{std::vector<Vector3d>(problem.mesh.nodes.size(), Vector3d::Zero()),
                          std::vector<Vector3d>(problem.mesh.nodes.size(), Vector3d::Zero())};
  for (int i = 0; i < n; ++i) solution.displacement[all.dof(i) / 3][all.dof(i) % 3] = x[i];
  for (int r = 0; r < m; ++r)
    for (const auto& [node, axis, weight] : rows[r].terms)
      solution.force[node][axis] -= weight * scale * x[n + r];  // lambda = -f
  return solution;
}

std::vector<Constraint> some_holds(const StaticProblem& problem, int count) {
  std::vector<Constraint> holds;
  const auto nodes = extract_surface(problem.mesh).nodes;
  for (std::size_t i = 0; i < nodes.size() && static_cast<int>(holds.size()) < 3 * count; i += 3) {
    if (!problem.dofs.is_free(nodes[i], 0)) continue;
    for (int axis = 0; axis < 3; ++axis) holds.push_back(hold(nodes[i], axis, 1e-3 * std::sin(7.0 * i + 2.0 * axis)));
  }
  return holds;
}

TEST(Direct, EqualsTheAugmentedSystemOfAnotherLibrary) {
  for (double poisson : {0.0, 0.3, 0.45, 0.499})
    for (double young : {1.0, 1e4, 1e12})
      for (int count : {1, 3, 12}) {
        const auto problem = make_static_problem(testing::make_body(young, poisson), testing::make_organ({5, 4, 3}));
        const auto holds = some_holds(problem, count);
        ASSERT_EQ(holds.size(), 3u * count);
        const auto direct = solve_direct(problem, holds), augmented = solve_augmented(problem, holds);
        EXPECT_LT(relative_difference(direct.displacement, augmented.displacement), 1e-9);
        EXPECT_LT(relative_difference(direct.force, augmented.force), 1e-9);
      }
}

TEST(Direct, EqualsTheAugmentedSystemForConditionsOverSeveralNodes) {
  const auto problem = make_static_problem(testing::make_body(), testing::make_organ({5, 4, 3}));
  auto constraints = some_holds(problem, 2);
  const std::array<int, 3> triangle = extract_surface(problem.mesh).triangles.back();
  for (int axis = 0; axis < 3; ++axis)
    constraints.push_back(
        {{{triangle[0], axis, 0.2}, {triangle[1], axis, 0.5}, {triangle[2], axis, 0.3}}, 1e-3 * (axis + 1)});
  const auto direct = solve_direct(problem, constraints), augmented = solve_augmented(problem, constraints);
  EXPECT_LT(relative_difference(direct.displacement, augmented.displacement), 1e-9);
  EXPECT_LT(relative_difference(direct.force, augmented.force), 1e-9);
}

TEST(Direct, HoldsExactlyAndBalancesForcesAndMoments) {
  const auto problem = make_static_problem(testing::make_body(), testing::make_organ({5, 4, 3}));
  const auto holds = some_holds(problem, 3);
  const auto solution = solve_direct(problem, holds);
  for (const auto& one : holds) EXPECT_EQ(solution.displacement[one.terms[0].node][one.terms[0].axis], one.value);
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
  double size = 0;
  for (std::size_t i = 0; i < solution.force.size(); ++i) {
    force += solution.force[i];
    moment += problem.mesh.nodes[i].cross(solution.force[i]);
    size += solution.force[i].norm();
  }
  EXPECT_LT(force.norm(), 1e-12 * size);
  EXPECT_LT(moment.norm(), 1e-12 * size);
}

TEST(Direct, LeavesFreeNodesWithoutForce) {
  const auto problem = make_static_problem(testing::make_body(), testing::make_organ({5, 4, 3}));
  const auto holds = some_holds(problem, 1);
  const auto solution = solve_direct(problem, holds);
  const int held = holds[0].terms[0].node;
  for (int node = 0; node < problem.dofs.nodes(); ++node) {
    if (!problem.dofs.is_free(node, 0) || node == held) continue;
    EXPECT_LT(solution.force[node].norm(), 1e-11 * solution.force[held].norm());
  }
}

TEST(Direct, RefusesFixedRepeatedAndContradictoryConditions) {
  const auto problem = make_static_problem(testing::make_body(), testing::make_organ({3, 3, 2}));
  const int top = static_cast<int>(problem.mesh.nodes.size()) - 1;
  EXPECT_THROW(solve_direct(problem, {hold(0, 1, 1e-3)}), std::runtime_error);
  EXPECT_THROW(solve_direct(problem, {hold(top, 1, 1e-3), hold(top, 1, 1e-3)}), std::runtime_error);
  const Constraint pair{{{top, 0, 0.5}, {top - 1, 0, 0.5}}, 1e-3};
  EXPECT_THROW(solve_direct(problem, {pair, pair}), std::runtime_error);
  EXPECT_NO_THROW(solve_direct(problem, {pair}));
}

TEST(Direct, DeadLoadsAndHoldsAreInverseToOneAnother) {
  const auto problem = make_static_problem(testing::make_body(), testing::make_organ({4, 4, 3}));
  const auto held = solve_direct(problem, some_holds(problem, 3));
  auto load = held.force;
  for (int node = 0; node < problem.dofs.nodes(); ++node)
    if (!problem.dofs.is_free(node, 0)) load[node].setZero();
  const auto loaded = solve_loads(problem, load);
  EXPECT_LT(relative_difference(loaded.displacement, held.displacement), 1e-10);
  EXPECT_LT(relative_difference(loaded.force, held.force), 1e-10);
}

}  // namespace
}  // namespace palpate
