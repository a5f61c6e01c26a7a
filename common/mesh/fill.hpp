#pragma once
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Fills a closed triangle surface with tetrahedra of edge length `size` [m] or less inside,
/// deterministically. The surface stays as it is: its nodes come first, in their order. Throws
/// std::runtime_error.
TetMesh fill_surface(const TriangleMesh& surface, double size);

}  // namespace palpate
