#include "tools/check_tool.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "common/contact/segment.hpp"
#include "common/contact/tool_contacts.hpp"
#include "common/contact/touch_surface.hpp"
#include "common/tool/instrument.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {
namespace {

/// Whether a part of a tool meets the body, or lies inside one that is solid.
bool meets(const Segment& axis, double radius, const Body& body, const TouchSurface& surface) {
  if (!body.shell && (surface.encloses(axis.start) || surface.encloses(axis.end))) return true;
  const double reach = radius + (body.shell ? 0.5 * body.shell->thickness : 0);
  for (int t = 0; t < surface.triangle_count(); ++t)
    if (closest_points(axis, surface.corners(t)).squared_distance < reach * reach) return true;
  return false;
}

bool meets(const Segment& axis, double radius, const Catheter& catheter) {
  const double reach = radius + catheter.radius;
  return closest_points(axis, Segment{catheter.tail, catheter.tip}).squared_distance < reach * reach;
}

void check_start(const Tool& tool, const ToolDofs& dofs, const Eigen::Isometry3d& pose, const Body& body,
                 const SurfaceMap& map) {
  std::optional<TouchSurface> surface;
  if (!body.catheter) surface.emplace(map, 2 * mean_edge(map));
  for (const ToolPart& part : tool_parts(tool, dofs.grip)) {
    const Segment axis = part.axis(pose);
    if (body.catheter ? meets(axis, part.radius, *body.catheter) : meets(axis, part.radius, body, *surface))
      throw std::runtime_error(fmt::format("{}: tool '{}' starts in contact with body '{}' or inside it",
                                           tool.trajectory.string(), tool.name, body.name));
  }
}

void print_end(const Tool& tool) {
  if (tool.kind == "forceps") {
    const Jaws& jaws = *tool.jaws;
    fmt::print(
        "tool '{}': forceps, jaws of {} m that open from 0 to {} rad, linkage {} N m/rad, friction {}, "
        "compliance {} m/N",
        tool.name, jaws.length, jaws.most_open, jaws.grip_stiffness, jaws.friction, tool.compliance);
    return;
  }
  fmt::print("tool '{}': tip radius {} m", tool.name, tool.radius);
  if (tool.cautery) fmt::print(", cautery of radius {} m", tool.cautery->radius);
  if (tool.jaws)
    fmt::print(", jaws {} x {} m that close below {} rad", tool.jaws->length, tool.jaws->width,
               tool.jaws->closed_below);
}

}  // namespace

void check_tool(const Scene& scene, const Tool& tool, const std::vector<SurfaceMap>& surfaces) {
  print_end(tool);
  fmt::print(", device {}", tool.device);
  if (tool.device != "scripted") {
    fmt::print("{}\n", tool.trajectory.empty() ? "" : " " + tool.trajectory.string());
    return;
  }
  const Trajectory trajectory = load_trajectory(tool.trajectory);
  check_grip(trajectory, tool);
  fmt::print(", {} s of {}\n", trajectory.duration(), tool.trajectory.filename().string());
  const Trocar trocar = make_trocar(tool.pivot, tool.axis, tool.up);
  for (std::size_t b = 0; b < surfaces.size(); ++b)
    check_start(tool, trajectory.at(0), tip_pose(trocar, trajectory.at(0)), scene.bodies[b], surfaces[b]);
}

}  // namespace palpate
