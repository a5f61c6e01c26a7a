#include "tools/check_tool.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "common/contact/tool_contacts.hpp"
#include "common/contact/touch_surface.hpp"
#include "common/geometry/segment.hpp"
#include "common/tool/instrument.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {
namespace {

/// Whether a part of a tool meets the body, or lies inside one that is solid.
bool meets(const Segment& axis, double radius, const Body& body, const TouchSurface& surface) {
  const auto* wall = as<ShellSpec>(body);
  if (!wall && (surface.encloses(axis.start) || surface.encloses(axis.end))) return true;
  const double reach = radius + (wall ? 0.5 * wall->shell.thickness : 0);
  for (int t = 0; t < surface.triangle_count(); ++t)
    if (closest_points(axis, surface.corners(t)).squared_distance < reach * reach) return true;
  return false;
}

bool meets(const Segment& axis, double radius, const Catheter& catheter) {
  const double reach = radius + catheter.radius;
  return closest_points(axis, Segment{catheter.tail, catheter.tip}).squared_distance < reach * reach;
}

/// `file`: the tool's trajectory.
void check_start(const Tool& tool, const std::filesystem::path& file, const ToolDofs& dofs, const Body& body,
                 const SurfaceMap& map) {
  const Eigen::Isometry3d pose = tip_pose(make_trocar(tool.pivot, tool.axis, tool.up), dofs);
  const auto* wire = as<CatheterSpec>(body);
  std::optional<TouchSurface> surface;
  if (!wire) surface.emplace(map, 2 * mean_edge(map));
  for (const ToolPart& part : tool_parts(tool, dofs.grip)) {
    const Segment axis = part.axis(pose);
    if (wire ? meets(axis, part.radius, wire->catheter) : meets(axis, part.radius, body, *surface))
      throw std::runtime_error(fmt::format("{}: tool '{}' starts in contact with body '{}' or inside it", file.string(),
                                           tool.name, name_of(body)));
  }
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

void check_tool(const Scene& scene, const Tool& tool, const std::vector<SurfaceMap>& surfaces) {
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
  for (std::size_t b = 0; b < surfaces.size(); ++b)
    check_start(tool, script->trajectory, trajectory.at(0), scene.bodies[b], surfaces[b]);
}

}  // namespace palpate
