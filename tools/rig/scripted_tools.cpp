#include "tools/rig/scripted_tools.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace palpate {

ScriptedTools::ScriptedTools(const Scene& scene) : dofs_(scene.tools.size()) {
  for (const Tool& tool : scene.tools) {
    const std::optional<Trajectory> script = script_of(tool.device);
    if (!script) throw std::runtime_error(fmt::format("tool '{}' is not scripted", tool.name));
    check_grip(*script, motion_file_of(tool.device), tool);
    motions_.push_back(*script);
  }
}

double ScriptedTools::duration() const {
  double longest = 0;
  for (const Trajectory& m : motions_) longest = std::max(longest, m.duration());
  return longest;
}

std::span<const ToolDofs> ScriptedTools::at(double time) {
  std::ranges::transform(motions_, dofs_.begin(), [&](const Trajectory& m) { return m.at(time); });
  return dofs_;
}

}  // namespace palpate
