#pragma once
#include <filesystem>

#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Reads Gmsh 1.0, 2.2, 4.1 (ASCII and binary) and legacy VTK through the gmsh library.
/// `scale` [m per mesh unit]. Throws std::runtime_error("FILE: element N: reason") on anything that is not a
/// mesh to compute with; the checks are those of quality.hpp.
TetMesh load_tet_mesh(const std::filesystem::path& file, double scale);

/// Reads a triangle surface (any format above, or STL) for drawing only, such as a rigid backdrop.
TriangleMesh load_triangle_mesh(const std::filesystem::path& file, double scale);

}  // namespace palpate
