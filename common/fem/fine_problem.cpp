#include "common/fem/fine_problem.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

#include "common/fem/hat_tractions.hpp"
#include "common/fem/ordering.hpp"
#include "common/fem/selection.hpp"
#include "common/fem/stopwatch.hpp"

namespace palpate {
namespace {

bool all_fixed(const Interpolation& hats, const DofMap& run_time, int axis) {
  for (int h = 0; h < hats.count; ++h)
    if (run_time.is_free(hats.node[h], axis)) return false;
  return true;
}

DofMap fine_dofs(const FineSpace& space, const DofMap& run_time) {
  std::vector<char> used(space.nodes.size(), 0);
  for (const auto& element : space.elements)
    for (int j = 0; j < space.per_element; ++j) used[element[j]] = 1;
  DofMap dofs(used);
  for (int node = 0; node < dofs.nodes(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (used[node] && all_fixed(space.interpolation[node], run_time, axis)) dofs.fix(node, axis);
  dofs.number();
  return dofs;
}

/// What the kernel says that programs may still take [bytes].
double free_memory() {
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("MemAvailable:")) return 1024 * std::stod(line.substr(13));
  return static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

void check_memory(const FineProblem& problem, double needed) {
  const double available = free_memory();
  if (needed < available) return;
  throw std::runtime_error(fmt::format(
      "body '{}': its offline discretisation has {} unknowns and needs about {:.1f} GB, but {:.1f} GB are free: refine "
      "less, or take element = \"p1\"",
      problem.body, problem.dofs.size(), 1e-9 * needed, 1e-9 * available));
}

}  // namespace

FineProblem make_fine_problem(const TetMesh& mesh, const Offline& offline, MaterialField materials, DofMap dofs,
                              const std::string& body) try {
  auto space = make_fine_space(mesh, offline);
  std::optional<Pressures> pressures;
  if (offline.formulation == Formulation::locking_free) pressures = make_pressures(space, materials);
  auto fine = fine_dofs(space, dofs);
  auto hats = hat_tractions(space, mesh);
  return {std::move(space), std::move(materials), std::move(pressures), std::move(fine), std::move(dofs), hats, body};
} catch (const std::bad_alloc&) {
  throw std::runtime_error(fmt::format("body '{}': not enough memory for its offline discretisation", body));
} catch (const std::runtime_error& error) {
  throw std::runtime_error(fmt::format("body '{}': [body.offline]: {}", body, error.what()));
}

FineProblem make_fine_problem(const SolidSpec& body, const TetMesh& mesh, const Offline& offline) {
  auto materials = material_field(body, mesh);
  auto dofs = apply_boundary_conditions(mesh, body.fixed, "body '" + body.name + "'");
  return make_fine_problem(mesh, offline, std::move(materials), std::move(dofs), body.name);
}

FineFactor::FineFactor(const FineProblem& problem, std::size_t further_bytes, const Progress& progress) {
  Stopwatch watch(progress);
  const auto* pressures = problem.pressures ? &*problem.pressures : nullptr;
  const auto graph = fine_graph(problem.space, pressures);
  const double blocks = static_cast<double>(graph.neighbour.size());
  check_memory(problem, blocks * 9 * (2 * sizeof(double) + sizeof(std::int64_t)));
  stiffness_ = assemble_stiffness(problem.space, problem.materials, pressures, problem.dofs, graph);
  watch.lap(fmt::format("assembly of {} unknowns", problem.dofs.size()));
  factor_.emplace(stiffness_, dof_order(problem.dofs, interior_first_order(graph, {})));
  watch.lap(fmt::format("ordering ({:.3g} Gflop, {:.3g} M entries)", 1e-9 * flops(), 1e-6 * nonzeros()));
  check_memory(problem, 1.3 * sizeof(double) * nonzeros() + static_cast<double>(further_bytes));
  factor_->factorise(stiffness_);
  watch.lap("factorisation");
}

Eigen::MatrixXd FineFactor::solve_corrected(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = factor_->solve(b);
  x += factor_->solve(b - stiffness_.selfadjointView<Eigen::Lower>() * x);
  return x;
}

}  // namespace palpate
