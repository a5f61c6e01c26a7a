#pragma once
#include "tools/organ/organ_mesh.hpp"

namespace palpate {

/// A closed surface as a solid of one part, and its measures.
struct SurfaceSolid {
  Solid solid;
  SolidMeasures measures;
};

/// Distances to the surface are kept on a grid of some million cells, and are exact near the surface. `surface`
/// outlives the solid. Throws std::runtime_error(reason) where it encloses no volume, or its walls are thinner than the
/// grid can tell.
SurfaceSolid solid_of(const TriangleMesh& surface);

}  // namespace palpate
