#pragma once
#include <filesystem>

#include "common/mesh/shell_mesh.hpp"

namespace palpate {

/// Reads a surface of triangles of three nodes: Gmsh and legacy VTK as load_tet_mesh() does, groups alike
/// (points, curves and surfaces; their nodes), and STL (no groups; a corner at the same place is one node,
/// numbered by its first appearance). `scale` [m per mesh unit]. The triangles are turned alike, then outward
/// where the shell encloses a volume (orient_shell). Throws std::runtime_error("FILE: reason") on solid
/// elements, on other surface elements, and on what check_shell_mesh() refuses. Forks a child process
/// (child.hpp): for set-up, not for a realtime loop.
ShellMesh load_shell_mesh(const std::filesystem::path& file, double scale);

/// Writes Gmsh 2.2 as text: nodes with the fewest digits that read back the same, groups as points under the
/// numbers 1, 2, ... in the order of their names. load_shell_mesh(file, 1) reads back the same nodes,
/// triangles and groups. Throws std::runtime_error("FILE: reason").
void write_shell_mesh(const ShellMesh& mesh, const std::filesystem::path& file);

}  // namespace palpate
