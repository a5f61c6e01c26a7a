#include "tools/check_duct.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "common/catheter/catheter_body.hpp"
#include "common/contact/segment.hpp"
#include "common/contact/tool_contacts.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/mesh/shell_quality.hpp"
#include "common/shell/fixation.hpp"
#include "common/tensors/find_archive.hpp"
#include "common/tensors/precompute_shell.hpp"
#include "tools/words.hpp"

namespace palpate {
namespace {

std::string name_of(const Body& body) {
  return fmt::format("body '{}'", body.name);
}

std::string kind_of(std::size_t mouths) {
  if (mouths == 0) return "a closed shell";
  return mouths == 2 ? "a tube with two open ends"
                     : fmt::format("a shell with {} boundary line{}", mouths, mouths == 1 ? "" : "s");
}

void print_fixation(const Body& body, const ShellMesh& mesh) {
  for (const FixedRegion& fixed : body.fixed) {
    std::string axes;
    for (int axis = 0; axis < 3; ++axis)
      if (fixed.axes[axis]) axes += "xyz"[axis];
    const auto nodes = select_nodes(mesh, fixed.where, name_of(body) + ": [[body.fixed]]");
    fmt::print("  fixed: {}, {} nodes along {}, {}\n", describe(fixed.where, "nodes"), nodes.size(), axes,
               fixed.rotations ? "clamped" : "hinged");
  }
}

void print_wall(const Body& body, const ShellMesh& mesh) {
  const Shell& shell = *body.shell;
  const std::size_t mouths = boundary_loops(mesh.triangles).size();
  fmt::print("  wall: {} m thick, bending {}; {}", shell.thickness, shell.bending, kind_of(mouths));
  if (mouths == 2) {
    const double radius = lumen_radius(mesh);
    fmt::print(", least radius {:.4g} m, t/R {:.3g}, {:.4g} m wide inside", radius, shell.thickness / radius,
               2 * radius - shell.thickness);
  }
  fmt::print("\n");
}

/// Frequencies [rad/s] of the kept modes, where an archive is there and good.
std::vector<double> known_frequencies(const Scene& scene, const Body& body) {
  if (!std::filesystem::exists(archive_path(scene, body))) return {};
  try {
    const Archive archive = find_archive(scene, body, ArchivePart::header);
    return archive.modal ? archive.modal->omega : std::vector<double>{};
  } catch (const std::exception&) {
    return {};  // refused, which the caller says
  }
}

void print_modes(const Scene& scene, const Body& body, int displacements) {
  const Shell& shell = *body.shell;
  const std::string damping = shell.damping > 0 ? fmt::format("damping {} 1/s", shell.damping)
                                                : fmt::format("damping ratio {}", shell.damping_ratio);
  fmt::print("  modes: {} of {} are kept, {}, {} residual flexibility\n", shell.modes, displacements, damping,
             shell.residual ? "with" : "without");
  const auto omega = known_frequencies(scene, body);
  if (!omega.empty())
    fmt::print("  frequencies: {:.4g} to {:.4g} Hz\n", omega.front() / (2 * std::numbers::pi),
               omega.back() / (2 * std::numbers::pi));
}

void check_rest(const Scene& scene, const Body& body) {
  for (const Body& duct : scene.bodies) {
    if (duct.name != body.catheter->inside) continue;
    const ShellMesh mesh = load_shell_mesh(duct.mesh, duct.scale);
    check_duct(scene, duct, mesh);
    const double reach = body.catheter->radius + 0.5 * duct.shell->thickness;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto closest = closest_points(Segment{body.catheter->tail, body.catheter->tip},
                                          Triangle{mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]});
      if (closest.squared_distance < reach * reach)
        throw std::runtime_error(fmt::format("{}: at rest it sticks in the wall of '{}'", name_of(body), duct.name));
    }
  }
}

}  // namespace

SurfaceMap check_shell_body(const Scene& scene, const Body& body) {
  const ShellMesh mesh = load_shell_mesh(body.mesh, body.scale);
  check_duct(scene, body, mesh);
  const ShellDofs dofs = shell_fixation(mesh, body, name_of(body));
  check_shell(body, mesh, dofs, name_of(body));
  const SurfaceMap surface = make_surface_map(body, mesh, dofs);
  fmt::print("{}: {} nodes, {} triangles, {} degrees of freedom; model {}\n", name_of(body), mesh.nodes.size(),
             mesh.triangles.size(), dofs.size(), body.model);
  fmt::print("  surface: {} nodes, mean edge {:.4g} m; {} nodes touchable\n", surface.size(), mean_edge(surface),
             surface.touchable);
  print_fixation(body, mesh);
  fmt::print("  material: young {} Pa, poisson {}, density {} kg/m3\n", body.material.young, body.material.poisson,
             body.material.density);
  print_wall(body, mesh);
  print_modes(scene, body, dofs.translations());
  return surface;
}

std::vector<MemoryPart> shell_memory(const Scene& scene, const Body& body, const SurfaceMap& surface) {
  std::vector<MemoryPart> parts = body_memory(scene, body, surface, 0);
  const std::size_t modes = body.shell->modes, rows = 3 * surface.position.size();
  parts.push_back({"disk", "archive: modes", sizeof(double) * (rows * modes + modes + surface.position.size())});
  if (!scene.tools.empty()) {
    parts.push_back({"haptic_node", "modes, by mode and by node", 2 * sizeof(double) * rows * modes});
    if (body.shell->residual)
      parts.push_back(
          {"haptic_node", "residual flexibility of each triangle", 81 * sizeof(double) * surface.triangles.size()});
  }
  parts.push_back({"render_node --deform", "modes, single precision", sizeof(float) * rows * modes});
  return parts;
}

void check_catheter(const Scene& scene, const Body& body) {
  const Catheter& catheter = *body.catheter;
  const CatheterSettings settings{catheter, body.material.young, body.material.density, 1 / scene.rates.haptic_hz};
  const Chain chain(catheter, body.material.young, body.material.density);
  const double area = std::numbers::pi * catheter.radius * catheter.radius;
  fmt::print("{}: {} particles {:.4g} m apart, {:.4g} m long, {} m thick; model {}\n", name_of(body),
             catheter.particles, chain.spacing(), (catheter.tip - catheter.tail).norm(), 2 * catheter.radius,
             body.model);
  if (!catheter.inside.empty()) fmt::print("  led into '{}'\n", catheter.inside);
  if (catheter.sleeve > 0) fmt::print("  sleeve: {} m from its tail\n", catheter.sleeve);
  fmt::print("  material: young {} Pa, density {} kg/m3; bending stiffness {:.4g} N m2\n", body.material.young,
             body.material.density, body.material.young * area * catheter.radius * catheter.radius / 4);
  int substeps = 1;
  try {
    substeps = CatheterBody(settings, nullptr).substeps();
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", name_of(body), error.what()));
  }
  fmt::print(
      "  springs: frequencies up to {:.4g} Hz; {}, {} step{} in each haptic one; damping {} 1/s, gravity {} "
      "{} {} m/s2\n",
      chain.frequency_bound() / (2 * std::numbers::pi), catheter.integrator, substeps, substeps == 1 ? "" : "s",
      catheter.damping, catheter.gravity.x(), catheter.gravity.y(), catheter.gravity.z());
  check_rest(scene, body);
}

std::vector<std::string> shell_warnings(const Body& body, const SurfaceMap& surface) {
  std::vector<std::string> warnings;
  const double edge = mean_edge(surface);
  if (body.shell->thickness > edge)
    warnings.push_back(
        fmt::format("body '{}' has a wall of {:.3g} m, thicker than the mean edge {:.3g} m of its mesh: "
                    "shell elements are for thin walls",
                    body.name, body.shell->thickness, edge));
  return warnings;
}

std::vector<std::string> catheter_warnings(const Scene& scene, const Body& body) {
  std::vector<std::string> warnings;
  const Catheter& catheter = *body.catheter;
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
