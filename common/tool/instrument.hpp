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

/// The shape of a tool of kind forceps; none for other kinds.
std::optional<ForcepsShape> forceps_shape(const Tool& tool);

/// Which parts of a tool feel what its jaws hold: from `first` up to `end`. A probe's are its tip.
struct JawParts {
  int first = 0, end = 1;
};
JawParts jaw_parts(const Tool& tool);

/// The parts of a tool of any kind for collision. `opening` [rad] between the jaws of a forceps; a probe has none.
std::vector<ToolPart> tool_parts(const Tool& tool, double opening = 0);

}  // namespace palpate
