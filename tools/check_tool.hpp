#pragma once
#include <span>
#include <string>
#include <vector>

#include "common/models/check/check.hpp"
#include "common/scene/scene.hpp"
#include "tools/shared/check_output.hpp"

namespace palpate {

/// Says what a tool is and refuses one that cannot start: a malformed trajectory, a grip beyond the jaws' range, a
/// first pose in contact with a body. `bodies`: what was found of the scene's. Throws std::runtime_error.
void check_tool(const Scene& scene, const Tool& tool, std::span<const CheckReport> bodies, CheckOutput& out);

/// A sentence for each tool whose trajectory comes to no body where it lies at rest.
std::vector<std::string> reach_warnings(const Scene& scene, std::span<const CheckReport> bodies);

}  // namespace palpate
