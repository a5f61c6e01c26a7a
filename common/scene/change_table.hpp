#pragma once
#include <toml++/toml.h>

#include "common/scene/scene_changes.hpp"

namespace palpate {

/// Puts the change into the table of a scene, new tables around it included. Throws std::runtime_error if the value is
/// no TOML, or an entry of a list is not named or is not there.
void change_table(toml::table& scene, const SceneChange& change);

}  // namespace palpate
