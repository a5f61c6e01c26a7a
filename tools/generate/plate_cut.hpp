#pragma once
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// The plate that is cut (RR3510 fig. 2): 0.05 x 0.11 x 0.01 m, 11 x 23 x 3 = 759 nodes 5 mm apart, 2,212
/// tetrahedra, centred at the origin in x and y, z from 0 up. Five tetrahedra to a cell, mirrored from cell
/// to cell; twelve pairs, spread over the plate, are three tetrahedra each instead. Group "corners": the
/// nodes of the four cells at the corners, through the thickness.
TetMesh make_plate_cut();

}  // namespace palpate
