#pragma once
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// A rigid backdrop in the two materials that it is drawn with.
struct Backdrop {
  TriangleMesh bones;   ///< closed parts whose triangles face outward: ribs, spine
  TriangleMesh lining;  ///< open sheets and closed parts that face inward: the wall of a cavity, seen from the side to
                        ///< which its normals point
};

/// Sorts the connected parts of a mesh: a part with an edge that only one triangle has is an open sheet.
/// Both keep all the nodes.
Backdrop sort_backdrop(const TriangleMesh& mesh);

}  // namespace palpate
