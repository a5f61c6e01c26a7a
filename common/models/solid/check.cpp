#include "common/models/solid/check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/contact/tool_contacts.hpp"
#include "common/fem/selection.hpp"
#include "common/mesh/measures.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/quality.hpp"
#include "common/models/check/visual_check.hpp"
#include "common/models/solid/precompute.hpp"

namespace palpate {
namespace {

void say_boundary_conditions(const SolidSpec& body, const TetMesh& mesh, CheckReport& report) {
  for (const BoundaryCondition& fixed : body.fixed) {
    const auto nodes = select_nodes(mesh, fixed.where, fmt::format("body '{}': [[body.fixed]]", body.name));
    report.say(fmt::format("  fixed: {}, {} nodes along {}", describe(fixed.where, "nodes"), nodes.size(),
                           letters(fixed.axes)));
  }
}

void say_material(const SolidSpec& body, CheckReport& report) {
  report.say(fmt::format("  material: young {} Pa, poisson {}, density {} kg/m3", body.material.young,
                         body.material.poisson, body.material.density));
  for (const MaterialRegion& region : body.materials)
    report.say(fmt::format("  in {}: young {} Pa, poisson {}, density {} kg/m3", describe(region.where, "elements"),
                           region.material.young, region.material.poisson, region.material.density));
}

double mass_of(const SolidSpec& body, const TetMesh& mesh) {
  const MaterialField materials = material_field(body, mesh);
  double mass = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    mass += materials.at(static_cast<int>(t)).density * tet_volume(mesh, mesh.tetrahedra[t]);
  return mass;
}

double max_poisson(const SolidSpec& body) {
  double largest = body.material.poisson;
  for (const auto& region : body.materials) largest = std::max(largest, region.material.poisson);
  return largest;
}

}  // namespace

CheckedSolid load_solid(const SolidSpec& body) {
  TetMesh mesh = load_tet_mesh(body.mesh, body.scale);
  DofMap dofs = apply_boundary_conditions(mesh, body.fixed, fmt::format("body '{}'", body.name));
  MaterialField materials = material_field(body, mesh);
  SurfaceMap surface = make_surface_map(body, mesh, dofs);
  return {std::move(mesh), std::move(dofs), std::move(materials), std::move(surface)};
}

void check_solid(const SolidSpec& body, std::string_view kind, const CheckedSolid& solid, const CheckSettings& settings,
                 CheckReport& report) {
  const SurfaceMap& surface = solid.surface;
  report.say(fmt::format("body '{}': {} nodes, {} tetrahedra, {} degrees of freedom; model {}", body.name,
                         solid.mesh.nodes.size(), solid.mesh.tetrahedra.size(), solid.dofs.size(), kind));
  report.say(fmt::format("  surface: {} nodes, {} triangles, mean edge {:.4g} m; {} nodes touchable", surface.size(),
                         surface.triangles.size(), mean_edge(surface), surface.touchable));
  const MeshMeasures measures = measures_of(solid.mesh);
  report.say("  size: " + say_size(measures, mass_of(body, solid.mesh)));
  report.say("  " + say_angles(measures));
  say_boundary_conditions(body, solid.mesh, report);
  say_material(body, report);
  if (body.materials.empty()) report.left_out.emplace_back("one material, nothing per element");
  report.warnings = size_warnings(settings, body.name, surface, true);
  report.meets = meets_surface(surface, true);
  check_visual(body, solid.mesh, report);
}

std::vector<std::string> material_warnings(const SolidSpec& body) {
  std::vector<std::string> warnings;
  const auto look = [&](double young) {
    if (young < kSoftestTissue || young > kStiffestTissue)
      warnings.push_back(
          fmt::format("body '{}' has young = {:.3g} Pa, and tissue has {:.3g} to {:.3g} Pa: is it in pascals?",
                      body.name, young, kSoftestTissue, kStiffestTissue));
  };
  look(body.material.young);
  for (const MaterialRegion& region : body.materials) look(region.material.young);
  return warnings;
}

std::vector<std::string> locking_warnings(const SolidSpec& body, const std::string& cure) {
  const double poisson = max_poisson(body);
  if (poisson < kLockingPoisson) return {};
  return {
      fmt::format("body '{}': linear elements lock at poisson = {} and are too stiff, by a tenth at {} and several "
                  "times at 0.4999: {}",
                  body.name, poisson, kLockingPoisson, cure)};
}

}  // namespace palpate
