#pragma once
#include <string>
#include <vector>

#include "common/models/hybrid/hybrid_split.hpp"

namespace palpate {

/// Partial connection (RR3510 sec. 6.2, fig. 4b): `fine`, then `coarse`, whose boundary nodes that coincide
/// with boundary nodes of `fine` (within a thousandth of its mean edge) become those. Nodes of `coarse` that
/// stay follow those of `fine`; groups of one name are one group. Throws std::runtime_error if no nodes
/// coincide or a tetrahedron collapses.
TetMesh join_meshes(const TetMesh& fine, const TetMesh& coarse, const std::string& where);

/// Fills in CondensedTensors::gap: every node of one part's boundary that faces the other part's boundary within
/// half a mean edge of the tensor-mass mesh and is no connection node, with the point opposite to it.
void add_gap(const TetMesh& joined, const HybridSplit& split, const std::vector<int>& index, CondensedTensors& tensors);

}  // namespace palpate
