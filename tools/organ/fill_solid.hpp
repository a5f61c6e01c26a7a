#pragma once
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "tools/organ/solid.hpp"

namespace palpate {

/// Where the mesh is finer than elsewhere: in a ball or in a box.
struct FinePlace {
  Eigen::Vector3d low, high;  ///< [m] of the box; of a ball, both its middle
  double radius = 0;          ///< [m] of the ball
  double edge = 0;            ///< [m] asked for inside; grows evenly outside

  double distance(const Eigen::Vector3d& x) const;  ///< [m] from the place; 0 inside
};

struct MeshSizes {
  double edge = 0;       ///< [m] asked for on the surface
  double inside = 0;     ///< [m] largest edge inside, where the mesh grows coarser
  double deviation = 0;  ///< [m] that the surface's triangles may be away from the solid's surface
  std::vector<FinePlace> fine;
};

/// Edge length [m] asked for at x.
double asked_edge(const MeshSizes& sizes, const Eigen::Vector3d& x, double depth);

/// Tetrahedra of the parts and the part of each.
struct FilledSolid {
  TetMesh mesh;           ///< without groups
  std::vector<int> part;  ///< of each tetrahedron, from 1
};

/// Fills the parts with tetrahedra by Delaunay refinement (CGAL's Mesh_3) and orders nodes and tetrahedra by place: the
/// same every time. Parts that touch share nodes. `better`: the worst tetrahedra are bettered, which takes most of the
/// time. Throws std::runtime_error.
FilledSolid fill_solid(const Solid& solid, const MeshSizes& sizes, bool better = true);

}  // namespace palpate
