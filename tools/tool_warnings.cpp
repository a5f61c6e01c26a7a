#include "tools/tool_warnings.hpp"

#include <fmt/format.h>

#include "common/tool/instrument.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {
namespace {

double pedal_time(const Trajectory& trajectory) {
  constexpr double kStep = 1e-3;
  double sum = 0;
  for (int i = 0; kStep * i < trajectory.duration(); ++i) sum += kStep * trajectory.at(kStep * i).pedal;
  return sum;
}

bool ever_closes(const Trajectory& trajectory, double closed_below) {
  constexpr double kStep = 1e-3;
  bool open = false;
  for (int i = 0; kStep * i <= trajectory.duration(); ++i) {
    const bool closed = trajectory.at(kStep * i).grip < closed_below;
    if (open && closed) return true;
    open = open || !closed;
  }
  return false;
}

}  // namespace

std::vector<std::string> tool_warnings(const Scene& scene) {
  std::vector<std::string> warnings;
  const bool cuttable = has_moving_tissue(scene);
  for (const Tool& tool : scene.tools) {
    const EndAbilities can = abilities_of(tool);
    if (can.cautery && !cuttable)
      warnings.push_back(fmt::format("tool '{}' has a cautery, and no body is dynamic: it cuts nothing", tool.name));
    const std::optional<Trajectory> script = script_of(tool.device);
    if (!script) continue;
    if (can.cautery && pedal_time(*script) == 0)
      warnings.push_back(
          fmt::format("tool '{}' has a cautery, and the pedal of its trajectory is never down", tool.name));
    if (can.closing && !ever_closes(*script, can.closing->closed_below))
      warnings.push_back(fmt::format("tool '{}' has jaws, and the grip of its trajectory never falls below {} rad",
                                     tool.name, can.closing->closed_below));
  }
  return warnings;
}

}  // namespace palpate
