#pragma once
#include <optional>
#include <vector>

#include "common/tool/forceps.hpp"
#include "common/tool/spec.hpp"
#include "common/tool/tool_part.hpp"

namespace palpate {

/// The parts of a probe: its tip, a sphere, and its shaft, a segment from behind the tip to `shaft_length` [m] back
/// from the tip's centre.
std::vector<ToolPart> probe_parts(double tip_radius, double shaft_radius, double shaft_length);

EndAbilities abilities_of(const Tool& tool);

/// The shape of a tool whose jaws turn; none of others.
std::optional<ForcepsShape> forceps_shape(const Tool& tool);

/// The parts of a tool of any kind for collision. `opening` [rad] between jaws that turn; others have none.
std::vector<ToolPart> tool_parts(const Tool& tool, double opening = 0);

}  // namespace palpate
