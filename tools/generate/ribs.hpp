#pragma once
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// A rigid backdrop around the liver, in its axes [m]: five pairs of ribs, open to the front, the spine, and
/// the wall around them (one-sided, facing inward). For the picture only.
TriangleMesh make_ribs();

}  // namespace palpate
