// What a check says of a thin wall.
#include <fmt/format.h>

#include <numbers>

#include "common/contact/tool_contacts.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/mesh/shell_quality.hpp"
#include "common/models/check/loads_check.hpp"
#include "common/models/check/surface_check.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "common/shell/boundary_conditions.hpp"

namespace palpate {
namespace {

std::string form_of(std::size_t mouths) {
  if (mouths == 0) return "a closed shell";
  return mouths == 2 ? "a tube with two open ends"
                     : fmt::format("a shell with {} boundary line{}", mouths, mouths == 1 ? "" : "s");
}

void say_boundary_conditions(const ShellSpec& body, const ShellMesh& mesh, CheckReport& report) {
  for (const ShellBoundaryCondition& fixed : body.fixed) {
    const auto nodes = select_nodes(mesh, fixed.where, fmt::format("body '{}': [[body.fixed]]", body.name));
    report.say(fmt::format("  fixed: {}, {} nodes along {}, {}", describe(fixed.where, "nodes"), nodes.size(),
                           letters(fixed.axes), fixed.rotations ? "clamped" : "hinged"));
  }
}

void say_wall(const Shell& shell, const ShellMesh& mesh, CheckReport& report) {
  const std::size_t mouths = boundary_loops(mesh.triangles).size();
  std::string wall =
      fmt::format("  wall: {} m thick, bending {}; {}", shell.thickness, word_of(shell.bending), form_of(mouths));
  if (mouths == 2) {
    const double radius = lumen_radius(mesh);
    wall += fmt::format(", least radius {:.4g} m, t/R {:.3g}, {:.4g} m wide inside", radius, shell.thickness / radius,
                        2 * radius - shell.thickness);
  }
  report.say(wall);
}

/// The frequencies are known where an archive is there and good.
void say_modes(const Shell& shell, int displacements, const std::optional<Archive>& archive, CheckReport& report) {
  const std::string damping = shell.damping > 0 ? fmt::format("damping {} 1/s", shell.damping)
                                                : fmt::format("damping ratio {}", shell.damping_ratio);
  report.say(fmt::format("  modes: {} of {} are kept, {}, {} residual flexibility", shell.modes, displacements, damping,
                         shell.residual ? "with" : "without"));
  if (archive && archive->modal)
    report.say(fmt::format("  frequencies: {:.4g} to {:.4g} Hz", archive->modal->omega.front() / (2 * std::numbers::pi),
                           archive->modal->omega.back() / (2 * std::numbers::pi)));
}

std::vector<MemoryPart> memory(const Shell& shell, const CheckSettings& settings, const SurfaceMap& surface) {
  constexpr int kFields = 3;  // position, displacement, normal
  std::vector<MemoryPart> parts = compliance_memory(settings, surface, 0, kFields);
  const std::size_t modes = shell.modes, rows = 3 * surface.position.size();
  parts.push_back({"disk", "archive: modes", sizeof(double) * (rows * modes + modes + surface.position.size())});
  if (!settings.tools.empty()) {
    parts.push_back({"haptic_node", "modes, by mode and by node", 2 * sizeof(double) * rows * modes});
    if (shell.residual)
      parts.push_back(
          {"haptic_node", "residual flexibility of each triangle", 81 * sizeof(double) * surface.triangles.size()});
  }
  parts.push_back({"render_node --deform", "modes, single precision", sizeof(float) * rows * modes});
  return parts;
}

}  // namespace

void check(const ModalShellSpec& body, const CheckSettings& settings, CheckReport& report) {
  const ShellMesh mesh = load_shell_mesh(body.mesh, body.scale);
  settings.check_guests(body, mesh);
  const std::string title = fmt::format("body '{}'", body.name);
  const ShellDofs dofs = apply_boundary_conditions(mesh, body, title);
  check_shell(body, mesh, dofs, title);
  const SurfaceMap surface = make_surface_map(body, mesh, dofs);
  report.say(fmt::format("{}: {} nodes, {} triangles, {} degrees of freedom; model {}", title, mesh.nodes.size(),
                         mesh.triangles.size(), dofs.size(), ModalShellSpec::kKind));
  report.say(fmt::format("  surface: {} nodes, mean edge {:.4g} m; {} nodes touchable", surface.size(),
                         mean_edge(surface), surface.touchable));
  say_boundary_conditions(body, mesh, report);
  report.say(fmt::format("  material: young {} Pa, poisson {}, density {} kg/m3", body.material.young,
                         body.material.poisson, body.material.density));
  shell_loads(body, mesh);  // which it refuses
  say_loads(body, body.gravity, settings, report);
  say_wall(body.shell, mesh, report);
  say_touched_by_mesh(settings, report);
  say_modes(body.shell, dofs.translations(), settings.stored(ArchivePart::header), report);
  report.memory = memory(body.shell, settings, surface);
  report.left_out.emplace_back("one material, nothing per element");
  report.warnings = size_warnings(settings, body.name, surface, false);
  if (const double edge = mean_edge(surface); body.shell.thickness > edge)
    report.warnings.push_back(
        fmt::format("body '{}' has a wall of {:.3g} m, thicker than the mean edge {:.3g} m of its mesh: "
                    "shell elements are for thin walls",
                    body.name, body.shell.thickness, edge));
  report.meets = meets_surface(surface, false, body.shell.thickness);
}

}  // namespace palpate
