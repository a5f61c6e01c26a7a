#pragma once
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Thin plate 0.1 x 0.1 x 0.008 m (TVCG99 fig. 5), centred at the origin in x and y, z from 0 up, `cells`
/// cells along each side and two through the thickness. Groups: those of make_block, and "corners": the nodes
/// within two cells of a corner, through the thickness.
TetMesh make_plate(int cells = 18);

}  // namespace palpate
