#pragma once
#include <span>
#include <vector>

#include "common/fem/fine_problem.hpp"

namespace palpate {

/// Columns of the compliance among nodes of a body, as many at a time as are asked for: what surface_compliance() gives
/// at once, from one sparse factor and blocks of right-hand sides.
class SurfaceColumns {
 public:
  /// `nodes`: of the mesh. Throws std::runtime_error as surface_compliance() does.
  SurfaceColumns(const TetMesh& mesh, const MaterialField& materials, const DofMap& dofs, const std::vector<int>& nodes,
                 const Progress& progress = {});
  /// Of the problem's run-time nodes. `further_bytes`: that will be needed beside the factor.
  SurfaceColumns(const FineProblem& problem, const std::vector<int>& nodes, std::size_t further_bytes,
                 const Progress& progress = {});

  /// [m/N] displacement of every node, three rows each, under unit forces on those at some places of `nodes`, three
  /// columns each; zero along fixed axes.
  Eigen::MatrixXd operator()(std::span<const int> loaded) const;
  double flops() const { return flops_; }  ///< of the factorisation and of all columns

 private:
  SparseMatrix loads_;  ///< of each node and axis on the free dofs; columns of fixed axes are zero
  std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)> solve_;
  double flops_ = 0;
};

}  // namespace palpate
