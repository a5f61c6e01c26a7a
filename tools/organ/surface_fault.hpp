#pragma once
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Throws std::runtime_error(reason), with the first place at fault, where triangles that are turned to agree are no
/// surface: an edge is used twice in one direction, or the triangles around a node do not hang together.
void check_is_surface(const TriangleMesh& mesh);

}  // namespace palpate
