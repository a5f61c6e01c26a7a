#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/fem/assembly.hpp"
#include "common/fem/constraint.hpp"
#include "common/fem/factorisation.hpp"
#include "common/fem/static_loads.hpp"

namespace palpate {

/// What a static solve of one body needs.
struct StaticProblem {
  TetMesh mesh;
  MaterialField materials;
  DofMap dofs;
};

/// Applies a scene's body to its mesh. Throws std::runtime_error as apply_boundary_conditions and material_field do.
StaticProblem make_static_problem(const SolidSpec& body, TetMesh mesh);

struct StaticSolution {
  std::vector<Eigen::Vector3d> displacement;  ///< [m] per mesh node
  std::vector<Eigen::Vector3d> force;         ///< [N] per mesh node, on the tissue: holds and reactions of fixed nodes
};

/// Solves the full system afresh, independently of any precomputed compliance. Axes held alone are eliminated
/// before the factorisation, as fixed ones are; conditions over several dofs follow by their multipliers, (J
/// K^-1 J^T) lambda = d - J u. Throws std::runtime_error if conditions repeat or contradict one another or
/// touch no free dof. `loads` act besides; those on held or fixed dofs go straight into what holds them.
StaticSolution solve_direct(const StaticProblem& problem, const std::vector<Constraint>& constraints,
                            const StaticLoads& loads = {});

/// The response to dead loads [N] per mesh node (those on fixed dofs go straight into the support).
StaticSolution solve_loads(const StaticProblem& problem, const std::vector<Eigen::Vector3d>& load);

}  // namespace palpate
