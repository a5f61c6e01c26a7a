#include <fmt/format.h>

#include <stdexcept>

#include "common/fem/fine_problem.hpp"
#include "common/geometry/dense_solvers.hpp"

namespace palpate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

void refuse_hold(const DofMap& dofs, const Constraint& constraint) {
  const auto& [node, axis, weight] = constraint.terms.at(0);
  throw std::runtime_error(
      fmt::format("node {} cannot be held along {}: {}", node, "xyz"[axis],
                  dofs.index(node, axis) == DofMap::kUnused ? "no element uses it" : "it is fixed"));
}

/// W J^T over the free fine dofs; fixed axes do not move and drop out.
MatrixXd condition_loads(const FineProblem& problem, const std::vector<Constraint>& constraints) {
  MatrixXd loads = MatrixXd::Zero(problem.dofs.size(), static_cast<Index>(constraints.size()));
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    bool free = false;
    for (const auto& [node, axis, weight] : constraints[c].terms) {
      if (!problem.run_time_dofs.is_free(node, axis)) continue;
      free = true;
      for (SparseMatrix::InnerIterator it(problem.hats, node); it; ++it) {
        const int row = problem.dofs.index(static_cast<int>(it.row()), axis);
        if (row >= 0) loads(row, static_cast<Index>(c)) += weight * it.value();
      }
    }
    if (!free) refuse_hold(problem.run_time_dofs, constraints[c]);
  }
  return loads;
}

std::vector<Vector3d> fine_field(const FineProblem& problem, const VectorXd& free) {
  std::vector<Vector3d> field(problem.space.nodes.size(), Vector3d::Zero());
  for (int i = 0; i < problem.dofs.size(); ++i) field[problem.dofs.dof(i) / 3][problem.dofs.dof(i) % 3] = free[i];
  return field;
}

/// Weighted means W^T u on the free axes of the run-time nodes.
std::vector<Vector3d> mean_displacement(const FineProblem& problem, const std::vector<Vector3d>& fine) {
  std::vector<Vector3d> mean(problem.run_time_dofs.nodes(), Vector3d::Zero());
  for (int node = 0; node < problem.run_time_dofs.nodes(); ++node)
    for (SparseMatrix::InnerIterator it(problem.hats, node); it; ++it)
      for (int axis = 0; axis < 3; ++axis)
        if (problem.run_time_dofs.is_free(node, axis)) mean[node][axis] += it.value() * fine[it.row()][axis];
  return mean;
}

/// What run-time nodes stand for of forces on fine nodes.
void gather_forces(const FineProblem& problem, const std::vector<Vector3d>& fine, std::vector<Vector3d>& force) {
  for (int node = 0; node < problem.dofs.nodes(); ++node) {
    const auto& hats = problem.space.interpolation[node];
    for (int h = 0; h < hats.count; ++h) force[hats.node[h]] += hats.weight[h] * fine[node];
  }
}

/// What the support exerts: K u at fixed fine dofs less the forces that are applied there.
std::vector<Vector3d> reactions(const FineProblem& problem, const std::vector<Vector3d>& fine,
                                const std::vector<Vector3d>& applied) {
  auto support =
      internal_force(problem.space, problem.materials, problem.pressures ? &*problem.pressures : nullptr, fine);
  for (int node = 0; node < problem.dofs.nodes(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      support[node][axis] =
          problem.dofs.index(node, axis) == DofMap::kFixed ? support[node][axis] - applied[node][axis] : 0;
  return support;
}

/// On the axes that may move.
std::vector<Vector3d> nodal_forces(const FineProblem& problem, const std::vector<NodalLoad>& loads) {
  std::vector<Vector3d> force(problem.run_time_dofs.nodes(), Vector3d::Zero());
  for (const NodalLoad& load : loads)
    for (int axis = 0; axis < 3; ++axis)
      if (problem.run_time_dofs.is_free(load.node, axis)) force.at(load.node)[axis] += load.force[axis];
  return force;
}

void add(const std::vector<Vector3d>& more, std::vector<Vector3d>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += more[i];
}

}  // namespace

StaticSolution solve_direct(const FineProblem& problem, const std::vector<Constraint>& constraints,
                            const StaticLoads& given) {
  const auto count = static_cast<Index>(constraints.size());
  const MatrixXd loads = condition_loads(problem, constraints);
  const std::vector<Vector3d> within = fine_load_vector(given, problem.space, problem.materials);
  std::vector<Vector3d> force = nodal_forces(problem, given.nodes);
  std::vector<Vector3d> applied = spread_loads(problem, force);
  add(within, applied);
  const FineFactor factor(problem, 4 * sizeof(double) * static_cast<std::size_t>(loads.size()));
  const MatrixXd response = count > 0 ? factor.solve_corrected(loads) : loads;
  const VectorXd moved = factor.solve_corrected(gather(problem.dofs, applied));  // by the given loads alone
  const MatrixXd compliance = loads.transpose() * response;
  const DenseCholesky schur(compliance);
  if (count > 0 && !schur.well_conditioned())
    throw std::runtime_error("the held points repeat or contradict one another");
  VectorXd value(count);
  for (Index c = 0; c < count; ++c) value[c] = constraints[c].value;
  const VectorXd multiplier = schur.solve(value - loads.transpose() * moved);

  std::vector<Vector3d> holding(force.size(), Vector3d::Zero());
  for (Index c = 0; c < count; ++c)
    for (const auto& [node, axis, weight] : constraints[c].terms)
      if (problem.run_time_dofs.is_free(node, axis)) holding[node][axis] += weight * multiplier[c];
  add(holding, force);
  add(spread_loads(problem, holding), applied);
  const auto fine = fine_field(problem, moved + response * multiplier);
  gather_forces(problem, within, force);
  gather_forces(problem, reactions(problem, fine, applied), force);
  return {mean_displacement(problem, fine), std::move(force)};
}

std::vector<Vector3d> spread_loads(const FineProblem& problem, const std::vector<Vector3d>& load) {
  std::vector<Vector3d> fine(problem.space.nodes.size(), Vector3d::Zero());
  for (int node = 0; node < problem.run_time_dofs.nodes(); ++node)
    for (SparseMatrix::InnerIterator it(problem.hats, node); it; ++it) fine[it.row()] += it.value() * load[node];
  return fine;
}

std::vector<Vector3d> solve_fine_loads(const FineProblem& problem, const std::vector<Vector3d>& fine_load) {
  const VectorXd right = gather(problem.dofs, fine_load);
  const FineFactor factor(problem, 8 * sizeof(double) * static_cast<std::size_t>(right.size()));
  return fine_field(problem, factor.solve_corrected(right));
}

}  // namespace palpate
