#pragma once
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Brings a mesh to a wanted number of tetrahedra without a new node: replaces `count` pairs of tetrahedra
/// that share a face by three around the edge between the two nodes that they do not share. Takes pairs far
/// from each other, of those whose three have the largest smallest dihedral angle; leaves groups of nodes as
/// they are and needs a mesh without groups of tetrahedra. Throws std::runtime_error where there are not that
/// many.
void flip_faces(TetMesh& mesh, int count);

}  // namespace palpate
