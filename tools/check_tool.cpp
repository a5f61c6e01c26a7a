#include "tools/check_tool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/devices/device.hpp"
#include "common/tool/instrument.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {
namespace {

/// `file`: the tool's motion, if it is in one.
void check_start(const Tool& tool, const std::filesystem::path& file, const ToolDofs& dofs, const Body& body,
                 const CheckReport& report) {
  const Eigen::Isometry3d pose = tip_pose(make_trocar(tool.pivot, tool.axis, tool.up), dofs);
  for (const ToolPart& part : tool_parts(tool, dofs.grip))
    if (report.meets(part.axis(pose), part.radius))
      throw std::runtime_error(fmt::format("{}tool '{}' starts in contact with body '{}' or inside it",
                                           file.empty() ? "" : file.string() + ": ", tool.name, name_of(body)));
}

/// Where a body hangs by its weight is not looked for.
bool may_reach(const Tool& tool, const Trajectory& script, std::span<const CheckReport> bodies) {
  constexpr int kTimes = 200;
  if (std::ranges::any_of(bodies, &CheckReport::sags)) return true;
  const Trocar trocar = make_trocar(tool.pivot, tool.axis, tool.up);
  for (int i = 0; i <= kTimes; ++i) {
    const ToolDofs dofs = script.at(script.duration() * i / kTimes);
    const Eigen::Isometry3d pose = tip_pose(trocar, dofs);
    for (const ToolPart& part : tool_parts(tool, dofs.grip))
      for (const CheckReport& body : bodies)
        if (body.meets(part.axis(pose), part.radius)) return true;
  }
  return false;
}

/// Where the tool is when the run begins; none where its driver has yet to say.
std::optional<ToolDofs> start_of(const Scene& scene, const Tool& tool) {
  const auto devices = make_devices(scene.tools, scene.rates.haptic_hz);
  Device& own = *devices[&tool - scene.tools.data()];
  if (!own.ready()) return {};
  return own.read(0).dofs;
}

}  // namespace

std::vector<std::string> reach_warnings(const Scene& scene, std::span<const CheckReport> bodies) {
  std::vector<std::string> warnings;
  for (const Tool& tool : scene.tools)
    if (const std::optional<Trajectory> script = script_of(tool.device); script && !may_reach(tool, *script, bodies))
      warnings.push_back(
          fmt::format("tool '{}' comes to no body on its way: its trajectory ends before, or goes past", tool.name));
  return warnings;
}

void check_tool(const Scene& scene, const Tool& tool, std::span<const CheckReport> bodies, CheckOutput& out) {
  const std::string said =
      fmt::format("{}, device {}", std::visit([&](const auto& end) { return sentence(end, tool); }, tool.end),
                  kind_of(tool.device));
  const std::filesystem::path file = motion_file_of(tool.device);
  const std::optional<Trajectory> script = script_of(tool.device);
  if (script) {
    out.say(fmt::format("{}, {} s{}", said, script->duration(), file.empty() ? "" : " of " + file.filename().string()));
    check_grip(*script, file, tool);
  } else {
    out.say(said + (file.empty() ? "" : " " + file.string()));
  }
  const std::optional<ToolDofs> start = script ? script->at(0) : start_of(scene, tool);
  for (std::size_t b = 0; start && b < bodies.size(); ++b) check_start(tool, file, *start, scene.bodies[b], bodies[b]);
}

}  // namespace palpate
