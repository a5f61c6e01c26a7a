#pragma once
#include <vector>

#include "common/archive/archive.hpp"
#include "common/scene/scene.hpp"

namespace palpate {

/// Prints a tool and refuses one that cannot start: a malformed trajectory, a grip beyond the jaws' range, a
/// first pose in contact with a body. `surfaces`: of the scene's bodies (nothing for a catheter). Throws
/// std::runtime_error.
void check_tool(const Scene& scene, const Tool& tool, const std::vector<SurfaceMap>& surfaces);

}  // namespace palpate
