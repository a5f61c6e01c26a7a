#pragma once
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Parts closed surfaces that touch in edges: around an edge of four triangles or more the two sides of each wedge of
/// material belong together, and each such pair comes to have nodes of its own, the copies behind the others; where
/// both ends of an edge hang together elsewhere, a node in its middle. An edge around which triangles do not enclose
/// material in turn stays as it is. The triangles that are halved for that have their second halves behind the others.
void part_crowded_edges(TriangleMesh& mesh);

}  // namespace palpate
