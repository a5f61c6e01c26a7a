#pragma once
#include <Eigen/SparseCore>

#include "common/fem/assembly.hpp"
#include "common/fem/fine_space.hpp"

namespace palpate {

/// The pressures of a locking-free body, eliminated. Dilatation reaches the energy through its mean over the elements
/// that share a pressure (FineSpace::per_pressure), with total volume V_a, alone:
///   p_a = modulus_a (B^T u)_a,   B_ja = int_a grad N_j,   modulus_a = lambda / V_a.
/// What remains is symmetric and positive definite, K = K(mu) + B diag(modulus) B^T, and couples no nodes but those of
/// one pressure. Pressures jump freely, where materials meet too.
struct Pressures {
  Eigen::SparseMatrix<double> divergence;  ///< B [m^2]: 3 * node + axis x pressures
  Eigen::VectorXd modulus;                 ///< [Pa/m^3]

  /// [Pa] of every pressure, tension positive: lambda times the mean dilatation.
  Eigen::VectorXd operator()(const std::vector<Eigen::Vector3d>& displacement) const;
};

Pressures make_pressures(const FineSpace& space, const MaterialField& materials);

/// Which nodes the stiffness couples: those of one element, or of all that share a pressure.
NodeGraph fine_graph(const FineSpace& space, const Pressures* pressures);

/// Lower triangle of the stiffness over the free dofs [N/m]. `materials` are those of the run-time tetrahedra;
/// `pressures` null: the displacement formulation.
SparseMatrix assemble_stiffness(const FineSpace& space, const MaterialField& materials, const Pressures* pressures,
                                const DofMap& dofs, const NodeGraph& graph);

/// Nodal forces K u [N] over all nodes, fixed ones included.
std::vector<Eigen::Vector3d> internal_force(const FineSpace& space, const MaterialField& materials,
                                            const Pressures* pressures,
                                            const std::vector<Eigen::Vector3d>& displacement);

/// Stress [Pa] of an element at barycentric coordinates. `pressure`: of every pressure, null without.
Eigen::Matrix3d fine_stress(const FineSpace& space, const MaterialField& materials, const Eigen::VectorXd* pressure,
                            const std::vector<Eigen::Vector3d>& displacement, int element, const Eigen::Vector4d& at);

}  // namespace palpate
