#include "common/fem/direct.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common/geometry/dense_solvers.hpp"

namespace palpate {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// The problem with the singly held dofs eliminated too.
struct Reduced {
  DofMap dofs;
  std::vector<Vector3d> displacement;         // prescribed values, zero elsewhere
  std::vector<const Constraint*> conditions;  // the ones left
};

const char* obstacle(const DofMap& dofs, int node, int axis) {
  if (dofs.index(node, axis) == DofMap::kUnused) return "no element uses it";
  return dofs.is_free(node, axis) ? "it is held already" : "it is fixed";
}

Reduced eliminate_holds(const StaticProblem& problem, const std::vector<Constraint>& constraints) {
  Reduced reduced{problem.dofs, std::vector<Vector3d>(problem.mesh.nodes.size(), Vector3d::Zero()), {}};
  for (const auto& constraint : constraints) {
    if (constraint.terms.size() > 1) {
      reduced.conditions.push_back(&constraint);
      continue;
    }
    const auto& [node, axis, weight] = constraint.terms.at(0);
    if (!reduced.dofs.is_free(node, axis))
      throw std::runtime_error(
          fmt::format("node {} cannot be held along {}: {}", node, "xyz"[axis], obstacle(problem.dofs, node, axis)));
    reduced.dofs.fix(node, axis);
    reduced.displacement[node][axis] = constraint.value / weight;
  }
  reduced.dofs.number();
  return reduced;
}

void scatter_add(const DofMap& dofs, const VectorXd& values, std::vector<Vector3d>& field) {
  for (int i = 0; i < dofs.size(); ++i) field[dofs.dof(i) / 3][dofs.dof(i) % 3] += values[i];
}

/// Adds the free response to the conditions' multipliers.
void impose_conditions(const Reduced& reduced, const Factorisation& factor, std::vector<Vector3d>& displacement) {
  const auto count = static_cast<Eigen::Index>(reduced.conditions.size());
  MatrixXd rows = MatrixXd::Zero(reduced.dofs.size(), count);  // J^T
  VectorXd gap(count);
  for (Eigen::Index c = 0; c < count; ++c) {
    gap[c] = reduced.conditions[c]->value;
    for (const auto& [node, axis, weight] : reduced.conditions[c]->terms) {
      gap[c] -= weight * displacement[node][axis];
      if (reduced.dofs.is_free(node, axis)) rows(reduced.dofs.index(node, axis), c) += weight;
    }
  }
  const MatrixXd response = factor.solve(rows);
  const MatrixXd compliance = rows.transpose() * response;
  const DenseCholesky schur(compliance);
  if (!schur.well_conditioned())
    throw std::runtime_error("the held points repeat or contradict one another, or act on fixed nodes alone");
  scatter_add(reduced.dofs, response * schur.solve(gap), displacement);
}

}  // namespace

StaticProblem make_static_problem(const SolidSpec& body, TetMesh mesh) {
  auto materials = material_field(body, mesh);
  auto dofs = apply_boundary_conditions(mesh, body.fixed, "body '" + body.name + "'");
  return {std::move(mesh), std::move(materials), std::move(dofs)};
}

StaticSolution solve_direct(const StaticProblem& problem, const std::vector<Constraint>& constraints,
                            const StaticLoads& loads) {
  auto reduced = eliminate_holds(problem, constraints);
  StaticSolution solution{std::move(reduced.displacement), {}};
  if (reduced.dofs.size() > 0) {
    const auto stiffness = assemble_stiffness(problem.mesh, problem.materials, reduced.dofs);
    Factorisation factor(stiffness);
    factor.factorise(stiffness);
    const std::vector<Vector3d> load = load_vector(loads, problem.mesh, problem.materials);
    // One more pass than needed: the second corrects the first by its own residual.
    for (int pass = 0; pass < 2; ++pass) {
      auto lacking = internal_force(problem.mesh, problem.materials, solution.displacement);
      for (std::size_t node = 0; node < load.size(); ++node) lacking[node] -= load[node];
      scatter_add(reduced.dofs, factor.solve(-gather(reduced.dofs, lacking)), solution.displacement);
    }
    if (!reduced.conditions.empty()) impose_conditions(reduced, factor, solution.displacement);
  }
  solution.force = internal_force(problem.mesh, problem.materials, solution.displacement);
  return solution;
}

StaticSolution solve_loads(const StaticProblem& problem, const std::vector<Vector3d>& load) {
  const auto stiffness = assemble_stiffness(problem.mesh, problem.materials, problem.dofs);
  Factorisation factor(stiffness);
  factor.factorise(stiffness);
  StaticSolution solution{std::vector<Vector3d>(problem.mesh.nodes.size(), Vector3d::Zero()), {}};
  scatter_add(problem.dofs, factor.solve(gather(problem.dofs, load)), solution.displacement);
  solution.force = internal_force(problem.mesh, problem.materials, solution.displacement);
  return solution;
}

}  // namespace palpate
