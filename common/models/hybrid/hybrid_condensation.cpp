#include "common/models/hybrid/hybrid_condensation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/fem/dense.hpp"
#include "common/fem/factorisation.hpp"
#include "common/geometry/dense_solvers.hpp"

namespace palpate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kBlock = 64;

/// The quasi-static part's stiffness, with the dofs of the connection nodes (c) apart from the inner ones
/// (i).
struct Blocks {
  SparseMatrix inner;                                                   ///< K_ii, lower triangle
  Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t> coupling;  ///< K_ic
  MatrixXd connection;                                                  ///< K_cc
};

Blocks take_apart(const HybridSplit& split, const MaterialField& materials, const std::vector<Dof>& columns) {
  const auto whole = assemble_stiffness(split.quasi_static_mesh, materials, split.free);
  std::vector<int> column_of(split.free.size(), -1);
  for (std::size_t c = 0; c < columns.size(); ++c)
    column_of[split.free.index(columns[c].node, columns[c].axis)] = static_cast<int>(c);
  const auto inner_of = [&](std::int64_t k) {
    const int dof = split.free.dof(static_cast<int>(k));
    return split.inner.index(dof / 3, dof % 3);
  };
  const auto count = static_cast<Index>(columns.size());
  Blocks blocks{SparseMatrix(split.inner.size(), split.inner.size()), {}, MatrixXd::Zero(count, count)};
  blocks.inner.reserve(whole.nonZeros());
  std::vector<Eigen::Triplet<double, std::int64_t>> coupling;
  for (std::int64_t k = 0; k < whole.outerSize(); ++k) {
    const int inner = inner_of(k);
    if (inner >= 0) blocks.inner.startVec(inner);
    for (SparseMatrix::InnerIterator entry(whole, k); entry; ++entry) {
      const int r = column_of[entry.row()], c = column_of[k];
      if (r < 0 && c < 0)
        blocks.inner.insertBack(inner_of(entry.row()), inner) = entry.value();  // ascends as `whole` does
      else if (r < 0)
        coupling.emplace_back(inner_of(entry.row()), c, entry.value());
      else if (c < 0)
        coupling.emplace_back(inner, r, entry.value());
      else
        blocks.connection(r, c) = blocks.connection(c, r) = entry.value();
    }
  }
  blocks.inner.finalize();
  blocks.coupling.resize(split.inner.size(), count);
  blocks.coupling.setFromTriplets(coupling.begin(), coupling.end());
  return blocks;
}

std::vector<Index> inner_indices(const HybridSplit& split, const std::vector<Dof>& rows) {
  std::vector<Index> indices;
  for (const Dof& dof : rows) indices.push_back(split.inner.index(dof.node, dof.axis));
  return indices;
}

void factorise(Factorisation& factor, const SparseMatrix& inner) try {
  factor.factorise(inner);
} catch (const std::runtime_error& error) {
  throw std::runtime_error(
      std::string("some quasi-static tetrahedra hang by a corner or an edge alone and would float (") + error.what() +
      "); draw the regions otherwise");
}

/// [rad^2/s^2] of K_cc against the lumped mass of the same nodes. Since S, and S with points held, take no
/// more energy than K_cc does for the same displacements (u_i = 0 is one of the shapes that they may choose),
/// it bounds them all.
double largest_eigenvalue(const MatrixXd& connection, const std::vector<Dof>& columns,
                          const std::vector<double>& mass) {
  VectorXd scale(connection.rows());
  for (Index c = 0; c < scale.size(); ++c) scale[c] = 1 / std::sqrt(mass[columns[c].node]);
  const MatrixXd scaled = scale.asDiagonal() * connection * scale.asDiagonal();
  if (scaled.size() == 0) return 0;
  constexpr double kRounding = 1e-9;
  return (1 + kRounding) * symmetric_eigenvalues(scaled).maxCoeff();
}

}  // namespace

void condense_on_connection(const HybridSplit& split, const MaterialField& materials, const std::vector<Dof>& rows,
                            const std::vector<Dof>& columns, const std::vector<double>& mass,
                            const std::vector<Eigen::Vector3d>& load, CondensedTensors& tensors) {
  const auto count = static_cast<Index>(columns.size());
  auto blocks = take_apart(split, materials, columns);
  const auto row_index = inner_indices(split, rows);
  MatrixXd& stiffness = blocks.connection;
  tensors.bound = largest_eigenvalue(stiffness, columns, mass);
  VectorXd reaction(count);
  for (Index c = 0; c < count; ++c) reaction[c] = load[columns[c].node][columns[c].axis];
  tensors.follow.assign(rows.size() * columns.size(), 0.0);
  tensors.sag.assign(rows.size(), 0.0);
  if (split.inner.size() > 0) {
    Factorisation factor(blocks.inner);
    factorise(factor, blocks.inner);
    for (Index begin = 0; begin < count; begin += kBlock) {
      const Index width = std::min(kBlock, count - begin);
      const MatrixXd solved = factor.solve(MatrixXd(blocks.coupling.middleCols(begin, width)));  // -H, all inner rows
      stiffness.middleCols(begin, width) -= blocks.coupling.transpose() * solved;
      for (std::size_t r = 0; r < rows.size(); ++r)
        for (Index c = 0; c < width; ++c) tensors.follow[r * count + begin + c] = -solved(row_index[r], c);
    }
    VectorXd inside(split.inner.size());
    for (int i = 0; i < split.inner.size(); ++i) inside[i] = load[split.inner.dof(i) / 3][split.inner.dof(i) % 3];
    const VectorXd sag = factor.solve(inside);
    reaction -= blocks.coupling.transpose() * sag;  // H^T w_i = -K_ci K_ii^-1 w_i
    for (std::size_t r = 0; r < rows.size(); ++r) tensors.sag[r] = sag[row_index[r]];
  }
  stiffness = (0.5 * (stiffness + stiffness.transpose())).eval();
  tensors.stiffness.resize(columns.size() * (columns.size() + 1) / 2);
  pack_lower_by_rows(stiffness, tensors.stiffness.data());
  tensors.reaction.assign(reaction.begin(), reaction.end());
}

}  // namespace palpate
