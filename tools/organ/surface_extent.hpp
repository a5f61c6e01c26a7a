#pragma once
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Refuses a surface that is no body's, or whose coordinates' digits do not tell its shape: 1 um to 1 km across, and no
/// farther from the origin than 1,000 times that. `surface` [m] has a triangle. Throws std::runtime_error(reason).
void check_extent(const TriangleMesh& surface);

}  // namespace palpate
