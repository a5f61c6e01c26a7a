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

}  // namespace

void check_tool(const Scene& scene, const Tool& tool, std::span<const CheckReport> bodies) {
  fmt::print("{}", std::visit([&](const auto& end) { return sentence(end, tool); }, tool.end));
  fmt::print(", device {}", kind_of(tool.device));
  const std::filesystem::path file = motion_file_of(tool.device);
  const std::optional<Trajectory> script = script_of(tool.device);
  if (!script) {
    fmt::print("{}\n", file.empty() ? "" : " " + file.string());
    return;
  }
  check_grip(*script, file, tool);
  fmt::print(", {} s of {}\n", script->duration(), file.filename().string());
  for (std::size_t b = 0; b < bodies.size(); ++b) check_start(tool, file, script->at(0), scene.bodies[b], bodies[b]);
}

}  // namespace palpate
