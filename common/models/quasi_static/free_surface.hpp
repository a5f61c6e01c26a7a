#pragma once
#include <vector>

#include "common/models/check/check.hpp"

namespace palpate {

/// The surface of a mesh that is held by its group kHeldBy, where it has one, and can be touched elsewhere. Throws
/// std::runtime_error where it has none.
SurfaceMap free_surface(const TetMesh& mesh);

/// What such a surface takes as that of a quasi-static body that one tool touches.
std::vector<MemoryPart> free_surface_memory(const SurfaceMap& surface);

}  // namespace palpate
