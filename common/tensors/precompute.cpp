#include "common/tensors/precompute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <stdexcept>

#include "common/fem/selection.hpp"
#include "common/fem/specimen.hpp"
#include "common/fem/stopwatch.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

bool any_free(const DofMap& dofs, int node) {
  return dofs.is_free(node, 0) || dofs.is_free(node, 1) || dofs.is_free(node, 2);
}

std::vector<char> touchable_mask(const Body& body, const TetMesh& mesh, const DofMap& dofs,
                                 const Surface& surface) {
  std::vector<char> allowed(mesh.nodes.size(), !body.touchable);
  const std::string place = fmt::format("body '{}': [body.touchable]", body.name);
  if (body.touchable)
    for (int node : select_nodes(mesh, *body.touchable, place)) allowed[node] = 1;
  std::vector<char> touchable(mesh.nodes.size(), 0);
  for (int node : surface.nodes) touchable[node] = allowed[node] && any_free(dofs, node);
  if (std::find(touchable.begin(), touchable.end(), 1) == touchable.end())
    throw std::runtime_error(place + " selects no free node of the surface");
  return touchable;
}

std::vector<Dof> free_dofs(const SurfaceMap& surface, int begin, int end) {
  std::vector<Dof> dofs;
  for (int node = begin; node < end; ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (!surface.fixed[node][axis]) dofs.push_back({node, axis});
  return dofs;
}

}  // namespace

SurfaceMap make_surface_map(const Body& body, const TetMesh& mesh, const DofMap& dofs) {
  const auto surface = extract_surface(mesh);
  const auto touchable = touchable_mask(body, mesh, dofs, surface);
  SurfaceMap map;
  map.node_number = surface.nodes;
  const auto rest = std::stable_partition(map.node_number.begin(), map.node_number.end(),
                                          [&](int node) { return touchable[node] != 0; });
  map.touchable = static_cast<int>(rest - map.node_number.begin());
  std::vector<int> index(mesh.nodes.size(), -1);
  for (int i = 0; i < static_cast<int>(map.node_number.size()); ++i) {
    const int node = map.node_number[i];
    index[node] = i;
    map.position.push_back(mesh.nodes[node]);
    map.fixed.push_back({!dofs.is_free(node, 0), !dofs.is_free(node, 1), !dofs.is_free(node, 2)});
  }
  for (const auto& triangle : surface.triangles)
    map.triangles.push_back({index[triangle[0]], index[triangle[1]], index[triangle[2]]});
  return map;
}

Archive precompute(const Body& body, const TetMesh& mesh, const TetMesh* specimen, const Progress& progress,
                   Route route, PrecomputeCost* cost) try {
  Stopwatch watch(progress);
  const auto dofs = apply_fixation(mesh, body.fixed, "body '" + body.name + "'");
  const auto materials = material_field(body, mesh);
  Archive archive;
  archive.body = body.name;
  archive.software = "palpate " PALPATE_VERSION;
  archive.mesh_nodes = static_cast<int>(mesh.nodes.size());
  for (const auto& material : materials.materials) {
    archive.young.push_back(material.young);
    archive.poisson.push_back(material.poisson);
  }
  archive.material_of_element = materials.of_element;
  archive.surface = make_surface_map(body, mesh, dofs);
  const auto& surface = archive.surface;
  archive.touchable_dofs = free_dofs(surface, 0, surface.touchable);
  archive.other_dofs = free_dofs(surface, surface.touchable, surface.size());
  watch.lap("surface");

  const auto split = surface.node_number.begin() + surface.touchable;
  auto compliance = surface_compliance(mesh, materials, dofs, {surface.node_number.begin(), split},
                                       {split, surface.node_number.end()}, progress, route);
  archive.touchable_compliance = std::move(compliance.touchable);
  archive.other_compliance = std::move(compliance.other);
  if (cost) *cost = {compliance.flops, compliance.condensed};
  if (specimen) {
    Stopwatch specimen_watch(progress);
    const auto slopes = press_specimen(*specimen, body.material);
    archive.specimen_force_slope = slopes.force;
    archive.specimen_radial_slope = slopes.radial;
    specimen_watch.lap("specimen");
  }
  return archive;
} catch (const std::bad_alloc&) {
  throw std::runtime_error(fmt::format("body '{}': not enough memory for its tensors", body.name));
}

}  // namespace palpate
