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

/// Adds what the support exerts: K u at fixed fine dofs less the applied forces that act there themselves.
void add_reactions(const FineProblem& problem, const std::vector<Vector3d>& fine, std::vector<Vector3d>& force) {
  auto support =
      internal_force(problem.space, problem.materials, problem.pressures ? &*problem.pressures : nullptr, fine);
  for (int node = 0; node < problem.run_time_dofs.nodes(); ++node)
    for (SparseMatrix::InnerIterator it(problem.hats, node); it; ++it) support[it.row()] -= it.value() * force[node];
  for (int node = 0; node < problem.dofs.nodes(); ++node)
    for (int axis = 0; axis < 3; ++axis) {
      if (problem.dofs.index(node, axis) != DofMap::kFixed) continue;
      const auto& hats = problem.space.interpolation[node];
      for (int h = 0; h < hats.count; ++h) force[hats.node[h]][axis] += hats.weight[h] * support[node][axis];
    }
}

}  // namespace

StaticSolution solve_direct(const FineProblem& problem, const std::vector<Constraint>& constraints,
                            const std::vector<NodalLoad>& given) {
  const auto count = static_cast<Index>(constraints.size());
  const MatrixXd loads = condition_loads(problem, constraints);
  std::vector<Vector3d> load(problem.run_time_dofs.nodes(), Vector3d::Zero());
  for (const NodalLoad& one : given) load[one.node] += one.force;
  const FineFactor factor(problem, 4 * sizeof(double) * static_cast<std::size_t>(loads.size()));
  const MatrixXd response = count > 0 ? factor.solve_corrected(loads) : loads;
  VectorXd moved = VectorXd::Zero(problem.dofs.size());  // by the given loads alone
  if (!given.empty()) moved = factor.solve_corrected(gather(problem.dofs, spread_loads(problem, load)));
  const MatrixXd compliance = loads.transpose() * response;
  const DenseCholesky schur(compliance);
  if (count > 0 && !schur.well_conditioned())
    throw std::runtime_error("the held points repeat or contradict one another");
  VectorXd value(count);
  for (Index c = 0; c < count; ++c) value[c] = constraints[c].value;
  const VectorXd multiplier = schur.solve(value - loads.transpose() * moved);

  const auto fine = fine_field(problem, moved + response * multiplier);
  StaticSolution solution{mean_displacement(problem, fine), load};
  for (Index c = 0; c < count; ++c)
    for (const auto& [node, axis, weight] : constraints[c].terms)
      if (problem.run_time_dofs.is_free(node, axis)) solution.force[node][axis] += weight * multiplier[c];
  add_reactions(problem, fine, solution.force);
  return solution;
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
