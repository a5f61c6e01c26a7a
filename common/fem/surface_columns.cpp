#include "common/fem/surface_columns.hpp"

#include <fmt/format.h>

#include <memory>

#include "common/fem/stopwatch.hpp"

namespace palpate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Triplets = std::vector<Eigen::Triplet<double, std::int64_t>>;

SparseMatrix make_loads(int rows, std::size_t nodes, const Triplets& entries) {
  SparseMatrix loads(rows, 3 * static_cast<std::int64_t>(nodes));
  loads.setFromTriplets(entries.begin(), entries.end());
  return loads;
}

double all_flops(double factor_flops, double factor_nonzeros, std::size_t nodes) {
  return factor_flops + 4 * factor_nonzeros * 3 * static_cast<double>(nodes);
}

}  // namespace

SurfaceColumns::SurfaceColumns(const TetMesh& mesh, const MaterialField& materials, const DofMap& dofs,
                               const std::vector<int>& nodes, const Progress& progress) {
  Stopwatch watch(progress);
  Triplets entries;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      if (dofs.is_free(nodes[i], axis)) entries.emplace_back(dofs.index(nodes[i], axis), 3 * i + axis, 1.0);
  loads_ = make_loads(dofs.size(), nodes.size(), entries);
  const SparseMatrix stiffness = assemble_stiffness(mesh, materials, dofs, node_graph(mesh));
  watch.lap("assembly");
  const auto factor = std::make_shared<Factorisation>(stiffness);
  flops_ = all_flops(factor->flops(), static_cast<double>(factor->factor_nonzeros()), nodes.size());
  watch.lap(fmt::format("ordering ({:.3g} Gflop follow)", 1e-9 * flops_));
  factor->factorise(stiffness);
  watch.lap("factorisation");
  solve_ = [factor](const MatrixXd& loads) { return factor->solve(loads); };
}

SurfaceColumns::SurfaceColumns(const FineProblem& problem, const std::vector<int>& nodes, std::size_t further_bytes,
                               const Progress& progress) {
  Triplets entries;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      if (!problem.run_time_dofs.is_free(nodes[i], axis)) continue;
      for (SparseMatrix::InnerIterator it(problem.hats, nodes[i]); it; ++it)
        if (const int row = problem.dofs.index(static_cast<int>(it.row()), axis); row >= 0)
          entries.emplace_back(row, 3 * i + axis, it.value());
    }
  loads_ = make_loads(problem.dofs.size(), nodes.size(), entries);
  const auto factor = std::make_shared<FineFactor>(problem, further_bytes, progress);
  flops_ = all_flops(factor->flops(), factor->nonzeros(), nodes.size());
  solve_ = [factor](const MatrixXd& loads) { return factor->solve(loads); };
}

MatrixXd SurfaceColumns::operator()(std::span<const int> loaded) const {
  MatrixXd loads = MatrixXd::Zero(loads_.rows(), 3 * static_cast<Index>(loaded.size()));
  for (std::size_t j = 0; j < loaded.size(); ++j)
    for (int axis = 0; axis < 3; ++axis)
      for (SparseMatrix::InnerIterator it(loads_, 3 * loaded[j] + axis); it; ++it)
        loads(it.row(), 3 * static_cast<Index>(j) + axis) = it.value();
  return loads_.transpose() * solve_(loads);
}

}  // namespace palpate
