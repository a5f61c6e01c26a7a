#pragma once
#include <Eigen/SparseCore>
#include <cstdint>
#include <string>
#include <vector>

#include "common/fem/boundary_conditions.hpp"
#include "common/fem/elasticity.hpp"

namespace palpate {

/// Column-major sparse matrix with 64-bit indices. Symmetric ones hold the lower triangle alone.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t>;

/// The material of every tetrahedron. With one material nothing is stored per element.
struct MaterialField {
  std::vector<Material> materials;        ///< the body's own first, then one per region
  std::vector<std::uint16_t> of_element;  ///< index into materials; empty: all elements have materials[0]
  std::vector<char> nodal_strain;         ///< elements that are TetElement::nodal_strain; empty: none

  const Material& at(int element) const { return materials[of_element.empty() ? 0 : of_element[element]]; }
  bool averages(std::size_t element) const { return !nodal_strain.empty() && nodal_strain[element]; }
};

/// The body's material and its regions; where regions overlap the later one holds. Throws std::runtime_error
/// if a region selects no element, or if the stiffest element is more than 1e10 times as stiff as the softest.
MaterialField material_field(const SolidSpec& body, const TetMesh& mesh);

/// Which nodes share a tetrahedron: for each node its neighbours with a greater or equal number, ascending,
/// itself first. Unused nodes have an empty list.
struct NodeGraph {
  std::vector<std::int64_t> begin;  ///< size nodes + 1
  std::vector<int> neighbour;
};

NodeGraph node_graph(const TetMesh& mesh);
/// Which nodes the stiffness couples: also those of one patch, where elements average their strain.
NodeGraph node_graph(const TetMesh& mesh, const MaterialField& materials);

/// Lower triangle over the free dofs of a matrix given by one 3 x 3 block (rows the greater node) per entry of the
/// graph, with exact zeros of the pattern kept.
SparseMatrix lower_triangle(const std::vector<Eigen::Matrix3d>& blocks, const DofMap& dofs, const NodeGraph& graph);

/// Lower triangle of the stiffness matrix over the free dofs [N/m], with exact zeros of the pattern kept.
SparseMatrix assemble_stiffness(const TetMesh& mesh, const MaterialField& materials, const DofMap& dofs,
                                const NodeGraph& graph);
SparseMatrix assemble_stiffness(const TetMesh& mesh, const MaterialField& materials, const DofMap& dofs);

/// Nodal forces f = K u [N] over all nodes, fixed ones included: what the outside exerts on the tissue.
std::vector<Eigen::Vector3d> internal_force(const TetMesh& mesh, const MaterialField& materials,
                                            const std::vector<Eigen::Vector3d>& displacement);

/// Stress [Pa] of every linear element under nodal displacements [m].
std::vector<Eigen::Matrix3d> element_stresses(const TetMesh& mesh, const MaterialField& materials,
                                              const std::vector<Eigen::Vector3d>& displacement);

}  // namespace palpate
