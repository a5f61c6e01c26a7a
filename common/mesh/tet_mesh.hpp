#pragma once
#include <Eigen/Core>
#include <array>
#include <map>
#include <string>
#include <vector>

namespace palpate {

/// A named part of a mesh file: a Gmsh physical group, under its name and under its number as text.
struct MeshGroup {
  std::vector<int> nodes;       ///< every node of the group's elements, of any dimension; ascending
  std::vector<int> tetrahedra;  ///< indices into TetMesh::tetrahedra; ascending
};

/// By which group of its nodes a mesh is held where nobody says another.
inline constexpr const char* kHeldBy = "attachment";

/// Linear tetrahedral mesh. Node numbers are 0-based positions in the mesh file's node list, nodes that no
/// element uses included. Tetrahedra are positively oriented: det[x1-x0, x2-x0, x3-x0] > 0.
struct TetMesh {
  std::vector<Eigen::Vector3d> nodes;          ///< [m] rest positions, world frame
  std::vector<std::array<int, 4>> tetrahedra;  ///< node numbers
  std::map<std::string, MeshGroup> groups;
};

/// Corners of the faces of a tetrahedron: face f lies opposite to vertex f, and of a positive tetrahedron its
/// right-hand normal points outward.
inline constexpr int kTetFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

/// Triangles with outward normals by the right-hand rule.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> nodes;         ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< indices into nodes
};

}  // namespace palpate
