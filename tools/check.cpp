#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "common/bus/roles.hpp"
#include "common/bus/security.hpp"
#include "common/contact/tool_contacts.hpp"
#include "common/fem/assembly.hpp"
#include "common/fem/boundary_conditions.hpp"
#include "common/fem/selection.hpp"
#include "common/fem/specimen.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/quasi_static/nonlinear.hpp"
#include "common/models/solid/precompute.hpp"
#include "common/scene/find_archive.hpp"
#include "tools/check_duct.hpp"
#include "tools/check_dynamic.hpp"
#include "tools/check_offline.hpp"
#include "tools/check_tool.hpp"
#include "tools/commands.hpp"
#include "tools/footprint.hpp"
#include "tools/words.hpp"

namespace palpate {
namespace {

template <class Part>
bool is_a(const Body& body) {
  return as<Part>(body) != nullptr;
}

void print_boundary_conditions(const SolidSpec& body, const TetMesh& mesh) {
  for (const BoundaryCondition& fixed : body.fixed) {
    std::string axes;
    for (int axis = 0; axis < 3; ++axis)
      if (fixed.axes[axis]) axes += "xyz"[axis];
    const auto nodes = select_nodes(mesh, fixed.where, fmt::format("body '{}': [[body.fixed]]", body.name));
    fmt::print("  fixed: {}, {} nodes along {}\n", describe(fixed.where, "nodes"), nodes.size(), axes);
  }
}

void print_material(const SolidSpec& body) {
  fmt::print("  material: young {} Pa, poisson {}, density {} kg/m3\n", body.material.young, body.material.poisson,
             body.material.density);
  for (const MaterialRegion& region : body.materials)
    fmt::print("  in {}: young {} Pa, poisson {}, density {} kg/m3\n", describe(region.where, "elements"),
               region.material.young, region.material.poisson, region.material.density);
}

void print_nonlinear(const QuasiStaticSpec& body) {
  if (!body.nonlinear) return;
  const Nonlinear& nonlinear = *body.nonlinear;
  Archive slopes;
  if (!nonlinear.specimen_mesh.empty()) {
    const auto pressed =
        press_specimen(load_tet_mesh(nonlinear.specimen_mesh, nonlinear.specimen_scale), body.material);
    slopes.specimen_force_slope = pressed.force;
    slopes.specimen_radial_slope = pressed.radial;
  }
  const QuasiNonlinear law = make_quasi_nonlinear(body, slopes);
  fmt::print(
      "  quasi non-linear correction: degree {}, {} ends; fitted up to a linear force of {:.3g} N and a "
      "linear "
      "radial displacement of {:.3g} m\n",
      nonlinear.degree, nonlinear.specimen_mesh.empty() ? "sliding" : "stuck", law.force_curve().end(),
      law.radial_curve().end());
}

void print_archive(const Scene& scene, const Body& body) {
  const auto file = archive_path(body);
  if (!std::filesystem::exists(file)) {
    fmt::print("  archive: not computed yet, `palpate precompute` does it\n");
    return;
  }
  try {
    find_archive(scene, body, ArchivePart::header);
    fmt::print("  archive: {} ({})\n", file.string(), human(std::filesystem::file_size(file)));
  } catch (const std::exception& error) {
    fmt::print("  archive: refused and to be rebuilt, because {}\n", error.what());
  }
}

void print_memory(const std::vector<MemoryPart>& parts) {
  for (const MemoryPart& part : parts) fmt::print("  {:>10}  {:<20}  {}\n", human(part.bytes), part.owner, part.what);
}

SurfaceMap check_solid_body(const Scene& scene, const Body& body, const SolidSpec& solid) {
  const bool moves = is_a<MovingSpec>(body);
  const TetMesh mesh = load_tet_mesh(solid.mesh, solid.scale);
  const DofMap dofs = apply_boundary_conditions(mesh, solid.fixed, fmt::format("body '{}'", solid.name));
  const MaterialField materials = material_field(solid, mesh);
  SurfaceMap surface = make_surface_map(solid, mesh, dofs);
  Archive moving;
  if (moves) moving = dynamic_archive(scene, body, mesh);
  fmt::print("body '{}': {} nodes, {} tetrahedra, {} degrees of freedom; model {}\n", solid.name, mesh.nodes.size(),
             mesh.tetrahedra.size(), dofs.size(), kind_of(body));
  fmt::print("  surface: {} nodes, {} triangles, mean edge {:.4g} m; {} nodes touchable\n", surface.size(),
             surface.triangles.size(), mean_edge(surface), surface.touchable);
  print_boundary_conditions(solid, mesh);
  print_material(solid);
  if (const auto* still = as<QuasiStaticSpec>(body)) {
    print_offline(*still, mesh);
    print_nonlinear(*still);
  }
  if (moves) print_dynamic(body, mesh, moving);

  print_archive(scene, body);
  print_memory(moves ? dynamic_memory(scene, body, moving)
                     : body_memory(scene, body, surface, materials.of_element.size()));
  return surface;
}

/// Loads and validates a body's mesh and everything that refers to it. A catheter has no surface before it
/// moves.
SurfaceMap check_body(const Scene& scene, const Body& body) {
  if (const auto* solid = as<SolidSpec>(body)) return check_solid_body(scene, body, *solid);
  if (const auto* wire = as<CatheterSpec>(body)) {
    check_catheter(scene, *wire);
    return {};
  }
  SurfaceMap surface = check_shell_body(scene, body);
  print_archive(scene, body);
  print_memory(shell_memory(scene, body, surface));
  return surface;
}

/// Keys are made apart from the scene, and a host may have those of its own nodes alone.
void print_keys(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) {
    fmt::print("  keys: {} is not there, so that no node starts; `palpate keys` makes it\n", folder.string());
    return;
  }
  fmt::print("  keys: {}\n", folder.string());
  for (const std::string& role : bus_roles()) try {
      fmt::print("    {}: until {}\n", role, last_day(find_keys(folder, role)));
    } catch (const std::runtime_error& error) {
      fmt::print("    {}: none, {}\n", role, std::string_view(error.what()).substr(9));  // without "network: "
    }
}

void print_sections(const Scene& scene) {
  fmt::print("contact: {} rule, friction {}\n", scene.contact.rule, scene.contact.friction);
  fmt::print("rates: haptic {} Hz, visual {} Hz\n", scene.rates.haptic_hz, scene.rates.visual_hz);
  fmt::print("network: domain {}, {}\n", scene.network.domain,
             scene.network.interface.empty() ? "loopback" : scene.network.interface);
  if (scene.network.security) print_keys(scene.network.security->keys);
  if (scene.record) fmt::print("record: {}\n", scene.record->file.string());
  if (!scene.render) return;
  fmt::print("render: {} x {}, coloured by {}\n", scene.render->width, scene.render->height, scene.render->colour);
  if (scene.render->backdrop.empty()) return;
  const TriangleMesh backdrop = load_triangle_mesh(scene.render->backdrop, scene.render->backdrop_scale);
  fmt::print("  backdrop: {} triangles, {}\n", backdrop.triangles.size(),
             human(backdrop.nodes.size() * sizeof(Eigen::Vector3f) + backdrop.triangles.size() * 3 * sizeof(int)));
}

void print_left_out(const Scene& scene) {
  fmt::print("left out:\n");
  for (const Body& body : scene.bodies) {
    const std::string& name = name_of(body);
    const auto* solid = as<SolidSpec>(body);
    if (is_a<ShellSpec>(body) || (solid && solid->materials.empty()))
      fmt::print("  body '{}': one material, nothing per element\n", name);
    const auto* still = as<QuasiStaticSpec>(body);
    if (still && !still->nonlinear) fmt::print("  body '{}': no quasi non-linear correction\n", name);
    const auto* moving = as<MovingSpec>(body);
    if (moving && !moving->tearing) fmt::print("  body '{}': does not tear by itself\n", name);
    if (moving) fmt::print("  body '{}': no archive in the haptic node\n", name);
  }
  if (std::ranges::none_of(scene.bodies, is_a<MovingSpec>))
    fmt::print("  no dynamic body: no masses, no cutting, no topology topic\n");
  if (std::ranges::none_of(scene.bodies, is_a<ShellSpec>)) fmt::print("  no shell: no modes\n");
  if (std::ranges::none_of(scene.bodies, is_a<CatheterSpec>))
    fmt::print("  no catheter: no particles and no task record\n");
  const auto works = [](const Tool& tool) { return tool.forceps() || tool.probe()->cautery || tool.probe()->jaws; };
  if (std::ranges::none_of(scene.tools, works)) fmt::print("  no cautery and no jaws\n");
  if (scene.tools.empty()) fmt::print("  no tool: no haptic node\n");
  const auto driven = [](const Tool& tool) { return std::holds_alternative<BusDeviceSpec>(tool.device); };
  if (std::ranges::none_of(scene.tools, driven))
    fmt::print("  no tool on the bus: no device topic and no thread for it\n");
  if (!scene.record) fmt::print("  no [record]: no recorder and no log file\n");
  if (!scene.network.security)
    fmt::print("  no [network.security]: no keys and no encryption; whoever is on the network can take part\n");
  if (!scene.render) fmt::print("  no [render]: default picture\n");
  if (!scene.render || scene.render->backdrop.empty()) fmt::print("  no backdrop\n");
  if (std::ranges::none_of(scene.bodies, is_a<MovingSpec>))
    fmt::print("  no surface topic, unless a deformation node of its own is asked for\n");
}

void print_warnings(const Scene& scene, const std::vector<SurfaceMap>& surfaces) {
  std::vector<std::string> warnings;
  const auto add = [&](const std::vector<std::string>& more) {
    warnings.insert(warnings.end(), more.begin(), more.end());
  };
  for (std::size_t b = 0; b < surfaces.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (const auto* wire = as<CatheterSpec>(body))
      add(catheter_warnings(scene, *wire));
    else
      add(body_warnings(scene, body, surfaces[b]));
    add(locking_warnings(body));
    if (const auto* shell = as<ShellSpec>(body)) add(shell_warnings(*shell, surfaces[b]));
  }
  add(cutting_warnings(scene));
  for (const std::string& sentence : warnings) fmt::print("warning: {}\n", sentence);
}

void check(const Scene& scene) {
  fmt::print("{}{}scene {}\n", scene.title, scene.title.empty() ? "" : "\n", scene.file.string());
  std::vector<SurfaceMap> surfaces;
  for (const Body& body : scene.bodies) surfaces.push_back(check_body(scene, body));
  for (const Tool& tool : scene.tools) check_tool(scene, tool, surfaces);
  print_sections(scene);
  print_left_out(scene);
  print_warnings(scene, surfaces);
  fmt::print("hash {}\n", scene_hash(scene));
}

}  // namespace

void add_check_command(cli::Command& app) {
  cli::Command command = app.add_command("check", "Validate a scene and say what will be built, and what it takes");
  auto file = std::make_shared<std::string>();
  command.add_option("SCENE", *file, "scene file").required();
  command.does([file] { check(load_scene(*file)); });
}

}  // namespace palpate
