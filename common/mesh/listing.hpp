#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palpate {

/// One element as the file lists it.
struct ListedElement {
  int type = 0;             ///< Gmsh's element type: 4 is a tetrahedron of four nodes, 2 a triangle, 15 a point
  int entity = 0;           ///< elementary entity that it belongs to
  std::vector<int> groups;  ///< physical group numbers; Gmsh 1 and 2 only, in Gmsh 4 they belong to the entity
  std::vector<int> nodes;   ///< positions in the node list
};

/// What stands in a mesh file's lists, in the order of the file. Programming interfaces of mesh libraries
/// lose that order, nodes that no element uses, and the group numbers of single elements.
struct FileListing {
  std::vector<std::uint64_t> node_numbers;  ///< the file's own numbers; 1, 2, ... in VTK, which has none
  std::vector<Eigen::Vector3d> nodes;       ///< coordinates [mesh units], by position in the node list
  std::vector<ListedElement> elements;
  bool groups_by_entity = false;  ///< Gmsh 4
};

/// The number of dimensions (0..3) of one of Gmsh's element types; -1 for a type that is not known.
int element_dimension(int type);

/// Lists Gmsh 1.0, 2.x, 4.1 (ASCII, binary) and legacy VTK up to version 4 (ASCII, binary). An element that
/// Gmsh 1 or 2 repeats because it is in several groups is listed once, with all of them.
/// Throws std::runtime_error("FILE: reason"); elements that name missing nodes are counted and listed by
/// their 0-based place among the file's tetrahedra, or by their place in the element list where they are no
/// tetrahedra.
FileListing list_mesh_file(const std::filesystem::path& file);

}  // namespace palpate
