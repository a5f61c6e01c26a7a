#pragma once
#include <vector>

#include "tools/organ/fill_solid.hpp"

namespace palpate {

/// Tetrahedra that hang together through faces.
struct MeshPiece {
  double volume = 0;      ///< [m^3]
  Eigen::Vector3d place;  ///< [m] of a node of it
};

/// The largest first.
std::vector<MeshPiece> pieces_of(const TetMesh& mesh);

/// Gives pieces of a part, all but its largest of less than a hundredth of its volume, to the part that each shares
/// most area of faces with: the mesher leaves such tetrahedra, which hang on their part by an edge or a corner alone.
/// Those that share a face with no other part stay.
void give_stray_pieces_away(FilledSolid& filled);

/// What bounds a body: closed surfaces, the outer one of every piece and one around each cavity, and handles in all of
/// them together: 0 of a ball, 1 of a torus.
struct Topology {
  int surfaces = 0, handles = 0;
  bool operator==(const Topology&) const = default;
};

Topology topology_of(const TetMesh& mesh);

/// The tetrahedra of one part, with all of the nodes.
TetMesh part_of(const FilledSolid& filled, int part);

}  // namespace palpate
