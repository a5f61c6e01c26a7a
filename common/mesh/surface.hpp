#pragma once
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// The boundary of a tetrahedral mesh.
struct Surface {
  std::vector<int> nodes;                     ///< node numbers on the boundary, ascending
  std::vector<std::array<int, 3>> triangles;  ///< node numbers of the mesh, outward by the right-hand rule
  std::vector<int> tetrahedra;                ///< per triangle, the tetrahedron that it bounds
};

/// Faces that belong to one tetrahedron only, in order of (tetrahedron, face).
Surface extract_surface(const TetMesh& mesh);

/// [m^2] share of each of the nodes in the area of triangles: a third of those around it.
std::vector<double> node_areas(const std::vector<Eigen::Vector3d>& nodes,
                               const std::vector<std::array<int, 3>>& triangles);

}  // namespace palpate
