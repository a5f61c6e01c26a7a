#pragma once
#include <filesystem>

#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Reads Gmsh 1.0, 2.2, 4.1 (.msh, ASCII and binary) and legacy VTK up to version 4.2 (.vtk, ASCII and
/// binary) through the gmsh library. `scale` [m per mesh unit]. Tetrahedra come in the order of the file's
/// element list, and their 0-based place among the file's tetrahedra is their element number. Groups are
/// found by name and by number as text. Groups of one name are one group. A number that groups of several
/// dimensions share is found as "point 1", "curve 1", "surface 1" or "volume 1" instead. Where every
/// tetrahedron of a file is negatively oriented, the file follows the opposite convention and all are turned;
/// a file where only some are is refused. Throws std::runtime_error("FILE: element N: reason") on anything
/// that is not a mesh to compute with; the checks are those of quality.hpp. May fork a child process
/// (child.hpp): for set-up, not for a realtime loop.
TetMesh load_tet_mesh(const std::filesystem::path& file, double scale);

/// Reads a triangle surface (any format above, or STL) for drawing only, such as a rigid backdrop. A file
/// without triangles gives the boundary of its tetrahedra. Nodes without a triangle are dropped.
TriangleMesh load_triangle_mesh(const std::filesystem::path& file, double scale);

/// How write_tet_mesh writes a .msh file.
struct MshFormat {
  double version = 4.1;  ///< 1, 2.2 or 4.1
  bool binary = false;
};

/// Writes Gmsh (.msh) or legacy VTK (.vtk). Gmsh 4.1 is read back by load_tet_mesh(file, 1) as it was: same
/// nodes (unused ones too), same groups. Tetrahedra come set of groups by set of groups, in their order
/// within each. Groups get the numbers 1, 2, ... in the order of their names. Gmsh 1 and 2 drop unused nodes,
/// and tetrahedra without a group go to a group "ungrouped"; Gmsh 1 also drops names, VTK drops groups.
/// Throws std::runtime_error("FILE: reason").
void write_tet_mesh(const TetMesh& mesh, const std::filesystem::path& file, MshFormat format = {});

/// Writes binary STL (single precision).
void write_stl(const TriangleMesh& mesh, const std::filesystem::path& file);

}  // namespace palpate
