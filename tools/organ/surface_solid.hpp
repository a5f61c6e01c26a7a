#pragma once
#include "tools/organ/organ_mesh.hpp"

namespace palpate {

/// A closed surface as a solid of one part, and its measures.
struct SurfaceSolid {
  Solid solid;
  SolidMeasures measures;
};

/// Distances to the surface are kept on a grid of `cells` along its longest extent, and are exact near the surface.
/// `surface` outlives the solid.
SurfaceSolid solid_of(const TriangleMesh& surface, int cells = 200);

}  // namespace palpate
