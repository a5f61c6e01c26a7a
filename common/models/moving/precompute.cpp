#include "common/models/moving/precompute.hpp"

#include <fmt/format.h>

#include <new>
#include <numeric>
#include <stdexcept>

#include "common/fem/body_loads.hpp"
#include "common/fem/condensation.hpp"
#include "common/fem/stopwatch.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/moving_kind.hpp"
#include "common/models/solid/precompute.hpp"

namespace palpate {
namespace {

std::vector<int> index_of_nodes(const SurfaceMap& surface, std::size_t nodes) {
  std::vector<int> index(nodes, -1);
  for (int i = 0; i < surface.size(); ++i) index[surface.node_number[i]] = i;
  return index;
}

/// On the nodes of the moving tetrahedra. `index`: of each mesh node in the archive, or -1.
void add_dead_loads(const SolidSpec& body, const TetMesh& mesh, const std::vector<int>& index, Archive& archive) {
  if (body.loads.empty()) return;
  std::vector<char> moves(archive.surface.size(), 0);
  for (const auto& t : archive.tetrahedra)
    for (const int node : t) moves[node] = 1;
  archive.load.assign(archive.surface.size(), Eigen::Vector3d::Zero());
  const auto load = force_vector(body_loads(body, mesh), mesh.nodes);
  for (std::size_t node = 0; node < load.size(); ++node)
    if (index[node] >= 0 && moves[index[node]]) archive.load[index[node]] = load[node];
}

}  // namespace

MaterialField materials_of(const MaterialField& whole, const std::vector<int>& elements) {
  MaterialField part{whole.materials, {}, {}};
  if (whole.of_element.empty()) return part;
  for (int e : elements) part.of_element.push_back(whole.of_element[e]);
  return part;
}

MaterialField with_elements(const MovingSpec& body, const std::vector<int>& moving, const TetMesh& mesh,
                            MaterialField materials) {
  if (body.dynamic.element == TetElement::linear) return materials;
  materials.nodal_strain.assign(mesh.tetrahedra.size(), 0);
  for (const int e : moving) materials.nodal_strain[e] = 1;
  return materials;
}

std::vector<int> add_moving_part(const SolidSpec& body, const TetMesh& mesh, const DofMap& dofs,
                                 const MaterialField& materials, const std::vector<int>& elements, Archive& archive) {
  std::vector<int> nodes;
  for (int e : elements) nodes.insert(nodes.end(), mesh.tetrahedra[e].begin(), mesh.tetrahedra[e].end());
  archive.surface = make_surface_map(body, mesh, dofs, nodes);
  auto index = index_of_nodes(archive.surface, mesh.nodes.size());
  for (int e : elements) {
    const auto& t = mesh.tetrahedra[e];
    archive.tetrahedra.push_back({index[t[0]], index[t[1]], index[t[2]], index[t[3]]});
  }
  add_dead_loads(body, mesh, index, archive);
  archive.parts.dynamic = true;
  archive.material_of_element = materials_of(materials, elements).of_element;
  for (const auto& material : materials.materials) archive.density.push_back(material.density);
  return index;
}

void add_compliance_at_rest(const TetMesh& mesh, const DofMap& dofs, const MaterialField& materials,
                            const Progress& progress, Archive& archive) {
  Stopwatch watch(progress);
  const SurfaceMap& surface = archive.surface;
  const std::vector<int> touchable(surface.node_number.begin(), surface.node_number.begin() + surface.touchable);
  archive.moving_dofs = free_dofs(surface, 0, surface.touchable);
  archive.moving_compliance = surface_compliance(mesh, materials, dofs, touchable, {}, progress).touchable;
  watch.lap("compliance at rest");
}

Archive precompute_moving(const MovingSpec& body, std::string_view kind, const TetMesh& mesh,
                          const Progress& progress) try {
  Stopwatch watch(progress);
  const auto dofs = apply_boundary_conditions(mesh, body.fixed, fmt::format("body '{}'", body.name));
  const auto materials = material_field(body, mesh);
  auto archive = start_archive(body, kind, mesh, materials);
  std::vector<int> all(mesh.tetrahedra.size());
  std::iota(all.begin(), all.end(), 0);
  add_moving_part(body, mesh, dofs, materials, all, archive);
  watch.lap("surface");
  add_compliance_at_rest(mesh, dofs, with_elements(body, all, mesh, materials), progress, archive);
  return archive;
} catch (const std::bad_alloc&) {
  throw std::runtime_error(fmt::format("body '{}': not enough memory for its tensors", body.name));
}

std::vector<std::string> archive_lines(const MovingSpec&, const Archive& archive) {
  return {fmt::format("{} tetrahedra that move with inertia", archive.tetrahedra.size())};
}

ArchiveJob moving_archive_job(const MovingSpec& body, std::string_view kind, const Progress& progress) {
  return [&body, kind, &progress, mesh = load_tet_mesh(body.mesh, body.scale)] {
    return precompute_moving(body, kind, mesh, progress);
  };
}

}  // namespace palpate
