#pragma once
#include "common/mesh/tet_mesh.hpp"
#include "tools/generate/implicit_shapes.hpp"

namespace palpate {

/// The shape of the default organ [m]: +x to the patient's left, +y to the back, +z to the head; the origin
/// lies inside, near the middle.
ImplicitShape liver_shape();

struct LiverOptions {
  int frequency = 8;            ///< of the geodesic sphere that is wrapped around: 10 f^2 + 2 surface nodes
  double inner_size = 0.01045;  ///< [m] edge length aimed at inside
};

/// Groups: "liver" (all tetrahedra) and "attachment" (surface nodes of the bare area, held by the diaphragm).
TetMesh make_liver(const LiverOptions& options);

}  // namespace palpate
