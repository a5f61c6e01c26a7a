#include "tools/rig/scripted_tools.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace palpate {

ScriptedTools::ScriptedTools(const Scene& scene) : dofs_(scene.tools.size()) {
  for (const Tool& tool : scene.tools) {
    const auto* script = std::get_if<ScriptedDeviceSpec>(&tool.device);
    if (!script) throw std::runtime_error(fmt::format("tool '{}' is not scripted", tool.name));
    motions_.push_back(load_trajectory(script->trajectory));
    check_grip(motions_.back(), script->trajectory, tool);
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
