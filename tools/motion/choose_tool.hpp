#pragma once
#include <string>

#include "common/scene/scene.hpp"

namespace palpate {

/// The place of a tool by its name; of the only one without a name. Throws std::runtime_error with the names there are.
int choose_tool(const Scene& scene, const std::string& name);

}  // namespace palpate
