#pragma once
#include <string>

#include "common/scene/scene.hpp"

namespace palpate::stability {

/// What rows of a table hold for: the scene with its meshes and motions (null: the general cases), how much is run, and
/// this very program.
std::string subject_of(const Scene* scene, bool quick);

}  // namespace palpate::stability
