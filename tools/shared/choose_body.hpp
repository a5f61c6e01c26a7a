#pragma once
#include <string>

#include "common/scene/scene.hpp"

namespace palpate {

/// The body of that name; without one the scene's only body. Throws std::runtime_error with the names there are.
const Body& choose_body(const Scene& scene, const std::string& name);

}  // namespace palpate
