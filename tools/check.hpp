#pragma once
#include "common/scene/scene.hpp"
#include "tools/shared/check_output.hpp"

namespace palpate {

/// Validates a scene with its meshes, motions and archives, and says what will be built, what is left out and what it
/// takes. Throws std::runtime_error in one sentence where it cannot run.
void check_scene(const Scene& scene, CheckOutput& out);

}  // namespace palpate
