#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// What the gmsh library finds in a mesh file, in its own order. (dimension, number) name groups and
/// entities.
struct LibraryMesh {
  std::vector<std::uint64_t> node_numbers;
  std::vector<Eigen::Vector3d> nodes;                      ///< [mesh units]
  std::vector<std::array<std::uint64_t, 4>> tetrahedra;    ///< node numbers
  std::vector<std::array<std::uint64_t, 3>> triangles;     ///< node numbers
  std::map<std::pair<int, int>, std::string> group_names;  ///< of the groups that have one
  std::map<std::pair<int, int>, std::vector<int>> groups_of_entity;
};

/// Reads a file that the library knows by its extension. The library works in a child process (child.hpp), unless its
/// answer to a file of the same bytes is kept (kept_reading.hpp). Throws std::runtime_error(reason).
LibraryMesh read_with_library(const std::filesystem::path& file);

/// Writes tetrahedra, groups and nodes; see write_tet_mesh in mesh_file.hpp. Same process rule and errors.
void write_with_library(const TetMesh& mesh, const std::filesystem::path& file, double version, bool binary);

/// Fills a closed surface with tetrahedra; see fill.hpp.
TetMesh fill_with_library(const TriangleMesh& surface, double size);

}  // namespace palpate
