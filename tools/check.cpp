#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "common/contact/tool_contacts.hpp"
#include "common/contact/touch_surface.hpp"
#include "common/contact/triangle.hpp"
#include "common/fem/assembly.hpp"
#include "common/fem/fixation.hpp"
#include "common/fem/selection.hpp"
#include "common/fem/specimen.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/nonlinear.hpp"
#include "common/tensors/find_archive.hpp"
#include "common/tensors/precompute.hpp"
#include "common/tool/instrument.hpp"
#include "common/tool/trajectory.hpp"
#include "tools/check_dynamic.hpp"
#include "tools/commands.hpp"
#include "tools/footprint.hpp"

namespace palpate {
namespace {

std::string human(std::size_t bytes) {
  const double b = static_cast<double>(bytes);
  if (b < 1e6) return fmt::format("{:.1f} kB", b * 1e-3);
  return b < 1e9 ? fmt::format("{:.1f} MB", b * 1e-6) : fmt::format("{:.2f} GB", b * 1e-9);
}

std::string describe(const Selector& where, const char* list) {
  if (!where.group.empty()) return fmt::format("group '{}'", where.group);
  return where.box ? "a box" : fmt::format("a list of {}", list);
}

void print_fixation(const Body& body, const TetMesh& mesh) {
  for (const FixedRegion& fixed : body.fixed) {
    std::string axes;
    for (int axis = 0; axis < 3; ++axis)
      if (fixed.axes[axis]) axes += "xyz"[axis];
    const auto nodes = select_nodes(mesh, fixed.where, fmt::format("body '{}': [[body.fixed]]", body.name));
    fmt::print("  fixed: {}, {} nodes along {}\n", describe(fixed.where, "nodes"), nodes.size(), axes);
  }
}

void print_material(const Body& body) {
  fmt::print("  material: young {} Pa, poisson {}, density {} kg/m3\n", body.material.young,
             body.material.poisson, body.material.density);
  for (const MaterialRegion& region : body.materials)
    fmt::print("  in {}: young {} Pa, poisson {}, density {} kg/m3\n", describe(region.where, "elements"),
               region.material.young, region.material.poisson, region.material.density);
}

void print_nonlinear(const Body& body) {
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
  const auto file = archive_path(scene, body);
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

/// Loads and validates a body's mesh and everything that refers to it.
SurfaceMap check_body(const Scene& scene, const Body& body) {
  const TetMesh mesh = load_tet_mesh(body.mesh, body.scale);
  const DofMap dofs = apply_fixation(mesh, body.fixed, fmt::format("body '{}'", body.name));
  const MaterialField materials = material_field(body, mesh);
  const SurfaceMap surface = make_surface_map(body, mesh, dofs);
  Archive moving;
  if (is_dynamic(body)) moving = dynamic_archive(scene, body, mesh);
  fmt::print("body '{}': {} nodes, {} tetrahedra, {} degrees of freedom; model {}\n", body.name,
             mesh.nodes.size(), mesh.tetrahedra.size(), dofs.size(), body.model);
  fmt::print("  surface: {} nodes, {} triangles, mean edge {:.4g} m; {} nodes touchable\n", surface.size(),
             surface.triangles.size(), mean_edge(surface), surface.touchable);
  print_fixation(body, mesh);
  print_material(body);
  print_nonlinear(body);
  if (is_dynamic(body)) print_dynamic(body, mesh, moving);

  print_archive(scene, body);
  const auto memory = is_dynamic(body) ? dynamic_memory(scene, body, moving)
                                       : body_memory(scene, body, surface, materials.of_element.size());
  for (const MemoryPart& part : memory)
    fmt::print("  {:>10}  {:<20}  {}\n", human(part.bytes), part.owner, part.what);
  return surface;
}

/// Throws if a tool's sphere meets the body's surface or lies inside it.
void check_start(const Tool& tool, const Eigen::Isometry3d& pose, const Body& body, const SurfaceMap& map) {
  const TouchSurface surface(map, 2 * mean_edge(map));
  for (const SampleSphere& sample : sample_tool(tool.radius, tool.shaft_radius, tool.shaft_length)) {
    const Eigen::Vector3d centre = pose * Eigen::Vector3d(0, 0, -sample.behind);
    bool meets = surface.encloses(centre);
    for (int t = 0; t < surface.triangle_count() && !meets; ++t)
      meets = closest_point(centre, surface.corners(t)).squared_distance < sample.radius * sample.radius;
    if (meets)
      throw std::runtime_error(fmt::format("{}: tool '{}' starts in contact with body '{}' or inside it",
                                           tool.trajectory.string(), tool.name, body.name));
  }
}

void check_tool(const Scene& scene, const Tool& tool, const std::vector<SurfaceMap>& surfaces) {
  fmt::print("tool '{}': tip radius {} m", tool.name, tool.radius);
  if (tool.cautery) fmt::print(", cautery of radius {} m", tool.cautery->radius);
  if (tool.jaws)
    fmt::print(", jaws {} x {} m that close below {} rad", tool.jaws->length, tool.jaws->width,
               tool.jaws->closed_below);
  fmt::print(", device {}", tool.device);
  if (tool.device != "scripted") {
    fmt::print("{}\n", tool.trajectory.empty() ? "" : " " + tool.trajectory.string());
    return;
  }
  const Trajectory trajectory = load_trajectory(tool.trajectory);
  fmt::print(", {} s of {}\n", trajectory.duration(), tool.trajectory.filename().string());
  const Trocar trocar = make_trocar(tool.pivot, tool.axis, tool.up);
  for (std::size_t b = 0; b < surfaces.size(); ++b)
    check_start(tool, tip_pose(trocar, trajectory.at(0)), scene.bodies[b], surfaces[b]);
}

void print_sections(const Scene& scene) {
  fmt::print("contact: {} rule, friction {}\n", scene.contact.rule, scene.contact.friction);
  fmt::print("rates: haptic {} Hz, visual {} Hz\n", scene.rates.haptic_hz, scene.rates.visual_hz);
  fmt::print("network: domain {}, {}\n", scene.network.domain,
             scene.network.interface.empty() ? "loopback" : scene.network.interface);
  if (scene.record) fmt::print("record: {}\n", scene.record->file.string());
  if (!scene.render) return;
  fmt::print("render: {} x {}, coloured by {}\n", scene.render->width, scene.render->height,
             scene.render->colour);
  if (scene.render->backdrop.empty()) return;
  const TriangleMesh backdrop = load_triangle_mesh(scene.render->backdrop, scene.render->backdrop_scale);
  fmt::print(
      "  backdrop: {} triangles, {}\n", backdrop.triangles.size(),
      human(backdrop.nodes.size() * sizeof(Eigen::Vector3f) + backdrop.triangles.size() * 3 * sizeof(int)));
}

void print_left_out(const Scene& scene) {
  fmt::print("left out:\n");
  for (const Body& body : scene.bodies) {
    if (body.materials.empty()) fmt::print("  body '{}': one material, nothing per element\n", body.name);
    if (!is_dynamic(body) && !body.nonlinear)
      fmt::print("  body '{}': no quasi non-linear correction\n", body.name);
    if (is_dynamic(body) && !body.tearing) fmt::print("  body '{}': does not tear by itself\n", body.name);
    if (is_dynamic(body)) fmt::print("  body '{}': no archive in the haptic node\n", body.name);
  }
  if (std::ranges::none_of(scene.bodies, is_dynamic))
    fmt::print("  no dynamic body: no masses, no cutting, no topology topic\n");
  const auto works = [](const Tool& tool) { return tool.cautery || tool.jaws; };
  if (std::ranges::none_of(scene.tools, works)) fmt::print("  no cautery and no jaws\n");
  if (scene.tools.empty()) fmt::print("  no tool: no haptic node\n");
  const bool driven = std::ranges::any_of(scene.tools, [](const Tool& t) { return t.device == "bus"; });
  if (!driven) fmt::print("  no tool on the bus: no device topic and no thread for it\n");
  if (!scene.record) fmt::print("  no [record]: no recorder and no log file\n");
  if (!scene.render) fmt::print("  no [render]: default picture\n");
  if (!scene.render || scene.render->backdrop.empty()) fmt::print("  no backdrop\n");
  if (std::ranges::none_of(scene.bodies, is_dynamic))
    fmt::print("  no surface topic, unless a deformation node of its own is asked for\n");
}

void check(const Scene& scene) {
  fmt::print("{}{}scene {}\n", scene.title, scene.title.empty() ? "" : "\n", scene.file.string());
  std::vector<SurfaceMap> surfaces;
  for (const Body& body : scene.bodies) surfaces.push_back(check_body(scene, body));
  for (const Tool& tool : scene.tools) check_tool(scene, tool, surfaces);
  print_sections(scene);
  print_left_out(scene);
  for (std::size_t b = 0; b < surfaces.size(); ++b)
    for (const std::string& sentence : body_warnings(scene, scene.bodies[b], surfaces[b]))
      fmt::print("warning: {}\n", sentence);
  for (const std::string& sentence : cutting_warnings(scene)) fmt::print("warning: {}\n", sentence);
  fmt::print("hash {}\n", scene_hash(scene));
}

}  // namespace

void add_check_command(CLI::App& app) {
  auto* command =
      app.add_subcommand("check", "Validate a scene and say what will be built, and what it takes");
  auto file = std::make_shared<std::string>();
  command->add_option("SCENE", *file, "scene file")->required();
  command->callback([file] { check(load_scene(*file)); });
}

}  // namespace palpate
