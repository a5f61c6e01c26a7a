#include "tools/check_tool.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common/tool/instrument.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {
namespace {

/// `file`: the tool's trajectory.
void check_start(const Tool& tool, const std::filesystem::path& file, const ToolDofs& dofs, const Body& body,
                 const CheckReport& report) {
  const Eigen::Isometry3d pose = tip_pose(make_trocar(tool.pivot, tool.axis, tool.up), dofs);
  for (const ToolPart& part : tool_parts(tool, dofs.grip))
    if (report.meets(part.axis(pose), part.radius))
      throw std::runtime_error(fmt::format("{}: tool '{}' starts in contact with body '{}' or inside it", file.string(),
                                           tool.name, name_of(body)));
}

void print_end(const Tool& tool) {
  if (const ForcepsSpec* forceps = tool.forceps()) {
    const ForcepsJaws& jaws = forceps->jaws;
    fmt::print(
        "tool '{}': forceps, jaws of {} m that open from 0 to {} rad, linkage {} N m/rad, friction {}, "
        "compliance {} m/N",
        tool.name, jaws.length, jaws.max_open, jaws.grip_stiffness, jaws.friction, tool.compliance);
    return;
  }
  const ProbeSpec& probe = *tool.probe();
  fmt::print("tool '{}': tip radius {} m", tool.name, probe.radius);
  if (probe.cautery) fmt::print(", cautery of radius {} m", probe.cautery->radius);
  if (probe.jaws)
    fmt::print(", jaws {} x {} m that close below {} rad", probe.jaws->length, probe.jaws->width,
               probe.jaws->closed_below);
}

}  // namespace

void check_tool(const Scene& scene, const Tool& tool, std::span<const CheckReport> bodies) {
  print_end(tool);
  fmt::print(", device {}", std::visit([](const auto& device) { return device.kKind; }, tool.device));
  const auto* script = std::get_if<ScriptedDeviceSpec>(&tool.device);
  if (!script) {
    const auto* log = std::get_if<LogDeviceSpec>(&tool.device);
    fmt::print("{}\n", log ? " " + log->trajectory.string() : "");
    return;
  }
  const Trajectory trajectory = load_trajectory(script->trajectory);
  check_grip(trajectory, script->trajectory, tool);
  fmt::print(", {} s of {}\n", trajectory.duration(), script->trajectory.filename().string());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    check_start(tool, script->trajectory, trajectory.at(0), scene.bodies[b], bodies[b]);
}

}  // namespace palpate
