#pragma once
#include "common/archive/archive.hpp"
#include "common/fem/boundary_conditions.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/models/hybrid/spec.hpp"

namespace palpate {

/// A body's mesh taken apart into the tetrahedra that move with inertia and the quasi-static ones (RR3510
/// sec. 6). Nodes keep their numbers.
struct HybridSplit {
  std::vector<int> dynamic, quasi_static;  ///< tetrahedra of the whole mesh, ascending
  TetMesh quasi_static_mesh;               ///< all nodes, the quasi-static tetrahedra in that order
  std::vector<char> connection;            ///< per node: both parts use it
  DofMap free;                             ///< dofs of the quasi-static part, fixed ones eliminated
  DofMap inner;                            ///< the same with the connection nodes held as well
  bool held_by_connection = false;         ///< some piece stands only because connection nodes hold it
};

/// The tetrahedra that the regions of [body.hybrid] name, ascending. Throws std::runtime_error if a region is
/// empty.
std::vector<int> dynamic_elements(const HybridSpec& body, const TetMesh& mesh);

/// Throws std::runtime_error if one part is empty, if they share no node, or if a piece of the quasi-static
/// part would float: a piece without a fixed node is let be where connection nodes hold it, for then its
/// stiffness is regular.
HybridSplit split_hybrid(const HybridSpec& body, const TetMesh& mesh, const DofMap& dofs, std::vector<int> dynamic);

/// CondensedTensors::interface: faces between the parts. `index`: archive node per mesh node.
std::vector<std::array<int, 4>> interface_faces(const TetMesh& mesh, const HybridSplit& split,
                                                const std::vector<int>& index);

}  // namespace palpate
