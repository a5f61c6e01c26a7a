#pragma once
#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Middle surface of a thin wall. Node numbers are 0-based positions in the mesh file's node list, nodes that no
/// triangle uses included. Triangles are oriented alike; of a tube they look outward, by the right-hand rule.
struct ShellMesh {
  std::vector<Eigen::Vector3d> nodes;         ///< [m] rest positions, world frame
  std::vector<std::array<int, 3>> triangles;  ///< node numbers
  std::map<std::string, MeshGroup> groups;    ///< nodes of physical groups (their tetrahedra stay empty)
};

}  // namespace palpate
