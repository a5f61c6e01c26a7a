#pragma once
#include <optional>

#include "common/fem/condensation.hpp"
#include "common/fem/direct.hpp"
#include "common/fem/factorisation.hpp"
#include "common/fem/fine_stiffness.hpp"

namespace palpate {

/// A static problem of a body with a better discretisation than its run-time mesh. Seen from outside it has the
/// run-time mesh's nodes: on the surface the displacement of node i is u_i = (W^T u)_i, a weighted mean over its
/// triangles, and a force on it is spread by the same weight (hat_tractions()); inside, it is that of the point.
///
/// A fine node is fixed along an axis where all run-time nodes are that it interpolates: held are the points, edges,
/// faces and tetrahedra that linear elements on the run-time mesh hold. Materials are those of the run-time
/// tetrahedra.
struct FineProblem {
  FineSpace space;
  MaterialField materials;             ///< of the run-time tetrahedra
  std::optional<Pressures> pressures;  ///< set for the locking-free formulation
  DofMap dofs;                         ///< of the fine nodes
  DofMap run_time_dofs;
  SparseMatrix hats;  ///< W
  std::string body;   ///< for error sentences
};

/// Throws std::runtime_error as make_fine_space(), apply_boundary_conditions() and material_field() do.
FineProblem make_fine_problem(const SolidSpec& body, const TetMesh& mesh, const Offline& offline);
/// The same with materials and boundary conditions of the run-time mesh given.
FineProblem make_fine_problem(const TetMesh& mesh, const Offline& offline, MaterialField materials, DofMap dofs,
                              const std::string& body);

/// The factor of the stiffness. Throws std::runtime_error where free memory is too small for it, before it is used.
class FineFactor {
 public:
  FineFactor(const FineProblem& problem, std::size_t further_bytes, const Progress& progress = {});

  /// K^-1 B for free dofs; `corrected` once by its own residual.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const { return factor_->solve(b); }
  void solve_into(const Eigen::MatrixXd& b, Eigen::MatrixXd& x, Factorisation::Scratch& scratch) const {
    factor_->solve_into(b, x, scratch);
  }
  Eigen::MatrixXd solve_corrected(const Eigen::MatrixXd& b) const;
  double flops() const { return factor_->flops(); }
  double nonzeros() const { return static_cast<double>(factor_->factor_nonzeros()); }

 private:
  SparseMatrix stiffness_;
  std::optional<Factorisation> factor_;
};

/// C = W^T K^-1 W over the same dofs and in the same order as surface_compliance() of the run-time mesh.
SurfaceCompliance surface_compliance(const FineProblem& problem, const std::vector<int>& touchable,
                                     const std::vector<int>& other, const Progress& progress = {});

/// solve_direct() of the run-time nodes. Fixed axes of the result do not move; reactions are gathered on the
/// run-time nodes that their fine nodes interpolate. Pressures and weight load the fine nodes themselves, and are told
/// likewise; what is on fixed axes of a node goes straight into what holds them.
StaticSolution solve_direct(const FineProblem& problem, const std::vector<Constraint>& constraints,
                            const StaticLoads& loads = {});

/// Forces [N] on run-time nodes as forces on fine nodes, W f.
std::vector<Eigen::Vector3d> spread_loads(const FineProblem& problem, const std::vector<Eigen::Vector3d>& load);

/// Displacements [m] of the fine nodes under dead loads [N] on them.
std::vector<Eigen::Vector3d> solve_fine_loads(const FineProblem& problem,
                                              const std::vector<Eigen::Vector3d>& fine_load);

}  // namespace palpate
