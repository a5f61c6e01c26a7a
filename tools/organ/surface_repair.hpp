#pragma once
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "tools/organ/finding.hpp"

namespace palpate {

/// A closed surface, its normals outward; of a body with cavities, those of a cavity point into it.
struct RepairedSurface {
  TriangleMesh mesh;
  bool crosses_itself = false;
};

/// Makes a closed surface of triangles as they come: joins corners at one place, leaves nodes
/// out that no triangle uses, takes away triangles that are there
/// twice or have no area, turns those that are turned against their neighbours, parts what is not manifold, closes
/// holes up to `max_hole` [m] across, 0 being a fifth of the diagonal of the shell with the largest area, and leaves
/// out shells apart from the largest. Surfaces that cross themselves stay as they are: the body is what they go round.
/// All that is wrong is added to `findings`, with its places. Throws std::runtime_error(reason) where a hole is larger
/// or cannot be closed.
RepairedSurface repair_surface(TriangleMesh mesh, double max_hole, std::vector<Finding>& findings);

}  // namespace palpate
