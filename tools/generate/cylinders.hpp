#pragma once
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// The cylinder that tears under its own weight (RR3510 fig. 3): 30 mm across and 50 mm high about the z
/// axis, z from 0 up; eight levels of 31 nodes (axis, rings of 12 and 18), 248 nodes and 889 tetrahedra.
/// Groups of nodes: bottom, top, side.
TetMesh make_cylinder_tear();

/// The hybrid cylinder (RR3510 fig. 6): of the same size, finer, with a level of nodes at mid-height. Groups:
/// bottom, top and side (nodes), "lower" and "upper" (the tetrahedra of the two halves).
TetMesh make_cylinder_hybrid();

}  // namespace palpate
