#pragma once
#include <string>
#include <vector>

#include "common/scene/scene.hpp"

namespace palpate {

/// What tools and dynamic bodies do not give each other: a pedal that is never down, jaws that never close, nothing to
/// cut.
std::vector<std::string> tool_warnings(const Scene& scene);

}  // namespace palpate
