#pragma once
#include <optional>
#include <vector>

#include "common/tool/forceps.hpp"
#include "common/tool/spec.hpp"
#include "common/tool/tool_part.hpp"

namespace palpate {

/// Spheres of a probe: the tip first, then the shaft at 1.5 radii from centre to centre, at most max_shaft_samples of
/// them.
inline constexpr int kMaxShaftSamples = 47;
std::vector<ToolPart> sample_tool(double tip_radius, double shaft_radius, double shaft_length);

EndAbilities abilities_of(const Tool& tool);

/// The shape of a tool whose jaws turn; none of others.
std::optional<ForcepsShape> forceps_shape(const Tool& tool);

/// The parts of a tool of any kind for collision. `opening` [rad] between jaws that turn; others have none.
std::vector<ToolPart> tool_parts(const Tool& tool, double opening = 0);

}  // namespace palpate
