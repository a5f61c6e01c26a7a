#include "common/tensors/precompute.hpp"

#include <fmt/format.h>

#include <new>
#include <stdexcept>

#include "common/fem/fine_problem.hpp"
#include "common/fem/specimen.hpp"
#include "common/fem/stopwatch.hpp"
#include "common/tensors/precompute_dynamic.hpp"

namespace palpate {

std::vector<Dof> free_dofs(const SurfaceMap& surface, int begin, int end) {
  std::vector<Dof> dofs;
  for (int node = begin; node < end; ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (!surface.fixed[node][axis]) dofs.push_back({node, axis});
  return dofs;
}

Archive start_archive(const Body& body, const TetMesh& mesh, const MaterialField& materials) {
  Archive archive;
  archive.body = body.name;
  archive.model = body.model;
  archive.software = "palpate " PALPATE_VERSION;
  archive.mesh_nodes = static_cast<int>(mesh.nodes.size());
  for (const auto& material : materials.materials) {
    archive.young.push_back(material.young);
    archive.poisson.push_back(material.poisson);
  }
  archive.material_of_element = materials.of_element;
  return archive;
}

Archive precompute(const Body& body, const TetMesh& mesh, const TetMesh* specimen, const Progress& progress,
                   Route route, PrecomputeCost* cost) try {
  if (body.model != "quasi_static") return precompute_dynamic(body, mesh, nullptr, progress);
  Stopwatch watch(progress);
  const auto dofs = apply_fixation(mesh, body.fixed, "body '" + body.name + "'");
  const auto materials = material_field(body, mesh);
  auto archive = start_archive(body, mesh, materials);
  archive.surface = make_surface_map(body, mesh, dofs);
  const auto& surface = archive.surface;
  archive.touchable_dofs = free_dofs(surface, 0, surface.touchable);
  archive.other_dofs = free_dofs(surface, surface.touchable, surface.size());
  watch.lap("surface");

  const auto split = surface.node_number.begin() + surface.touchable;
  const std::vector<int> touchable(surface.node_number.begin(), split), other(split, surface.node_number.end());
  auto compliance = is_finer(body.offline)
                        ? surface_compliance(make_fine_problem(mesh, *body.offline, materials, dofs, body.name),
                                             touchable, other, progress)
                        : surface_compliance(mesh, materials, dofs, touchable, other, progress, route);
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
