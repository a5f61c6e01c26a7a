#include "tools/check_duct.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "common/contact/tool_contacts.hpp"
#include "common/geometry/segment.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/mesh/shell_quality.hpp"
#include "common/models/catheter/catheter_body.hpp"
#include "common/models/catheter/check_duct.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "common/scene/find_archive.hpp"
#include "common/shell/boundary_conditions.hpp"
#include "tools/words.hpp"

namespace palpate {
namespace {

std::string title_of(const NamedSpec& body) {
  return fmt::format("body '{}'", body.name);
}

std::string form_of(std::size_t mouths) {
  if (mouths == 0) return "a closed shell";
  return mouths == 2 ? "a tube with two open ends"
                     : fmt::format("a shell with {} boundary line{}", mouths, mouths == 1 ? "" : "s");
}

void print_boundary_conditions(const ShellSpec& body, const ShellMesh& mesh) {
  for (const ShellBoundaryCondition& fixed : body.fixed) {
    std::string axes;
    for (int axis = 0; axis < 3; ++axis)
      if (fixed.axes[axis]) axes += "xyz"[axis];
    const auto nodes = select_nodes(mesh, fixed.where, title_of(body) + ": [[body.fixed]]");
    fmt::print("  fixed: {}, {} nodes along {}, {}\n", describe(fixed.where, "nodes"), nodes.size(), axes,
               fixed.rotations ? "clamped" : "hinged");
  }
}

void print_wall(const Shell& shell, const ShellMesh& mesh) {
  const std::size_t mouths = boundary_loops(mesh.triangles).size();
  fmt::print("  wall: {} m thick, bending {}; {}", shell.thickness, shell.bending, form_of(mouths));
  if (mouths == 2) {
    const double radius = lumen_radius(mesh);
    fmt::print(", least radius {:.4g} m, t/R {:.3g}, {:.4g} m wide inside", radius, shell.thickness / radius,
               2 * radius - shell.thickness);
  }
  fmt::print("\n");
}

/// Frequencies [rad/s] of the kept modes, where an archive is there and good.
std::vector<double> known_frequencies(const Scene& scene, const Body& body) {
  if (!std::filesystem::exists(archive_path(body))) return {};
  try {
    const Archive archive = find_archive(scene, body, ArchivePart::header);
    return archive.modal ? archive.modal->omega : std::vector<double>{};
  } catch (const std::exception&) {
    return {};  // refused, which the caller says
  }
}

/// `omega`: frequencies [rad/s], empty where they are not known.
void print_modes(const Shell& shell, int displacements, const std::vector<double>& omega) {
  const std::string damping = shell.damping > 0 ? fmt::format("damping {} 1/s", shell.damping)
                                                : fmt::format("damping ratio {}", shell.damping_ratio);
  fmt::print("  modes: {} of {} are kept, {}, {} residual flexibility\n", shell.modes, displacements, damping,
             shell.residual ? "with" : "without");
  if (!omega.empty())
    fmt::print("  frequencies: {:.4g} to {:.4g} Hz\n", omega.front() / (2 * std::numbers::pi),
               omega.back() / (2 * std::numbers::pi));
}

/// Every catheter that is led into the duct.
void check_guests(const Scene& scene, const ShellSpec& duct, const ShellMesh& mesh) {
  for (const Body& body : scene.bodies)
    if (const auto* wire = as<CatheterSpec>(body); wire && wire->catheter.inside == duct.name)
      check_duct(*wire, duct, mesh);
}

void check_rest(const Scene& scene, const CatheterSpec& body) {
  for (const Body& other : scene.bodies) {
    const auto* duct = as<ShellSpec>(other);
    if (!duct || duct->name != body.catheter.inside) continue;
    const ShellMesh mesh = load_shell_mesh(duct->mesh, duct->scale);
    check_guests(scene, *duct, mesh);
    const double reach = body.catheter.radius + 0.5 * duct->shell.thickness;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto closest = closest_points(Segment{body.catheter.tail, body.catheter.tip},
                                          Triangle{mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]});
      if (closest.squared_distance < reach * reach)
        throw std::runtime_error(fmt::format("{}: at rest it sticks in the wall of '{}'", title_of(body), duct->name));
    }
  }
}

}  // namespace

SurfaceMap check_shell_body(const Scene& scene, const Body& body) {
  const ShellSpec& spec = *as<ShellSpec>(body);
  const ShellMesh mesh = load_shell_mesh(spec.mesh, spec.scale);
  check_guests(scene, spec, mesh);
  const ShellDofs dofs = apply_boundary_conditions(mesh, spec, title_of(spec));
  check_shell(spec, mesh, dofs, title_of(spec));
  const SurfaceMap surface = make_surface_map(spec, mesh, dofs);
  fmt::print("{}: {} nodes, {} triangles, {} degrees of freedom; model {}\n", title_of(spec), mesh.nodes.size(),
             mesh.triangles.size(), dofs.size(), kind_of(body));
  fmt::print("  surface: {} nodes, mean edge {:.4g} m; {} nodes touchable\n", surface.size(), mean_edge(surface),
             surface.touchable);
  print_boundary_conditions(spec, mesh);
  fmt::print("  material: young {} Pa, poisson {}, density {} kg/m3\n", spec.material.young, spec.material.poisson,
             spec.material.density);
  print_wall(spec.shell, mesh);
  print_modes(spec.shell, dofs.translations(), known_frequencies(scene, body));
  return surface;
}

std::vector<MemoryPart> shell_memory(const Scene& scene, const Body& body, const SurfaceMap& surface) {
  std::vector<MemoryPart> parts = body_memory(scene, body, surface, 0);
  const Shell& shell = as<ShellSpec>(body)->shell;
  const std::size_t modes = shell.modes, rows = 3 * surface.position.size();
  parts.push_back({"disk", "archive: modes", sizeof(double) * (rows * modes + modes + surface.position.size())});
  if (!scene.tools.empty()) {
    parts.push_back({"haptic_node", "modes, by mode and by node", 2 * sizeof(double) * rows * modes});
    if (shell.residual)
      parts.push_back(
          {"haptic_node", "residual flexibility of each triangle", 81 * sizeof(double) * surface.triangles.size()});
  }
  parts.push_back({"render_node --deform", "modes, single precision", sizeof(float) * rows * modes});
  return parts;
}

void check_catheter(const Scene& scene, const CatheterSpec& body) {
  const Catheter& catheter = body.catheter;
  const CatheterSettings settings{catheter, body.material.young, body.material.density, 1 / scene.rates.haptic_hz};
  const Chain chain(catheter, body.material.young, body.material.density);
  const double area = std::numbers::pi * catheter.radius * catheter.radius;
  fmt::print("{}: {} particles {:.4g} m apart, {:.4g} m long, {} m thick; model {}\n", title_of(body),
             catheter.particles, chain.spacing(), (catheter.tip - catheter.tail).norm(), 2 * catheter.radius,
             CatheterSpec::kKind);
  if (!catheter.inside.empty()) fmt::print("  led into '{}'\n", catheter.inside);
  if (catheter.sleeve > 0) fmt::print("  sleeve: {} m from its tail\n", catheter.sleeve);
  fmt::print("  material: young {} Pa, density {} kg/m3; bending stiffness {:.4g} N m2\n", body.material.young,
             body.material.density, body.material.young * area * catheter.radius * catheter.radius / 4);
  int substeps = 1;
  try {
    substeps = CatheterBody(settings, nullptr).substeps();
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", title_of(body), error.what()));
  }
  fmt::print(
      "  springs: frequencies up to {:.4g} Hz; {}, {} step{} in each haptic one; damping {} 1/s, gravity {} "
      "{} {} m/s2\n",
      chain.frequency_bound() / (2 * std::numbers::pi), catheter.integrator, substeps, substeps == 1 ? "" : "s",
      catheter.damping, catheter.gravity.x(), catheter.gravity.y(), catheter.gravity.z());
  check_rest(scene, body);
}

std::vector<std::string> shell_warnings(const ShellSpec& body, const SurfaceMap& surface) {
  std::vector<std::string> warnings;
  const double edge = mean_edge(surface);
  if (body.shell.thickness > edge)
    warnings.push_back(
        fmt::format("body '{}' has a wall of {:.3g} m, thicker than the mean edge {:.3g} m of its mesh: "
                    "shell elements are for thin walls",
                    body.name, body.shell.thickness, edge));
  return warnings;
}

std::vector<std::string> catheter_warnings(const Scene& scene, const CatheterSpec& body) {
  std::vector<std::string> warnings;
  const Catheter& catheter = body.catheter;
  const double spacing = (catheter.tip - catheter.tail).norm() / (catheter.particles - 1);
  if (spacing > 2 * catheter.radius)
    warnings.push_back(
        fmt::format("catheter '{}' has its particles {:.3g} m apart, more than it is thick, {:.3g} m: a wall "
                    "can pass between them",
                    body.name, spacing, 2 * catheter.radius));
  if (catheter.integrator != "implicit") {
    const CatheterSettings settings{catheter, body.material.young, body.material.density, 1 / scene.rates.haptic_hz};
    if (const int substeps = CatheterBody(settings, nullptr).substeps(); substeps > 8)
      warnings.push_back(fmt::format("catheter '{}' is stiff: {} needs {} steps in each haptic one; implicit takes one",
                                     body.name, catheter.integrator, substeps));
  }
  return warnings;
}

}  // namespace palpate
