#include "common/tensors/precompute_dynamic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <numeric>
#include <stdexcept>

#include "common/fem/stopwatch.hpp"
#include "common/mesh/surface.hpp"
#include "common/tensors/join_meshes.hpp"
#include "common/tensors/precompute.hpp"
#include "common/tensors/precompute_hybrid.hpp"

namespace palpate {
namespace {

std::vector<int> index_of_nodes(const SurfaceMap& surface, std::size_t nodes) {
  std::vector<int> index(nodes, -1);
  for (int i = 0; i < surface.size(); ++i) index[surface.node_number[i]] = i;
  return index;
}

/// The materials of some of the mesh's tetrahedra, in their order.
MaterialField materials_of(const MaterialField& whole, const std::vector<int>& elements) {
  MaterialField part{whole.materials, {}};
  if (whole.of_element.empty()) return part;
  for (int e : elements) part.of_element.push_back(whole.of_element[e]);
  return part;
}

/// Fills in the surface map, the tetrahedra and the densities, for the tetrahedra `elements` that move with
/// inertia. Returns the archive's node per mesh node.
std::vector<int> add_moving_part(const Body& body, const TetMesh& mesh, const DofMap& dofs,
                                 const MaterialField& materials, const std::vector<int>& elements, Archive& archive) {
  std::vector<int> nodes;
  for (int e : elements) nodes.insert(nodes.end(), mesh.tetrahedra[e].begin(), mesh.tetrahedra[e].end());
  archive.surface = make_surface_map(body, mesh, dofs, nodes);
  auto index = index_of_nodes(archive.surface, mesh.nodes.size());
  for (int e : elements) {
    const auto& t = mesh.tetrahedra[e];
    archive.tetrahedra.push_back({index[t[0]], index[t[1]], index[t[2]], index[t[3]]});
  }
  archive.material_of_element = materials_of(materials, elements).of_element;
  for (const auto& material : materials.materials) archive.density.push_back(material.density);
  return index;
}

/// Moves the faces of quasi-static elements to the front of the surface's triangles; returns how many there
/// are.
int quasi_static_first(const TetMesh& mesh, const HybridSplit& split, SurfaceMap& surface) {
  const auto bounded = extract_surface(mesh).tetrahedra;  // in the order of surface.triangles
  std::vector<std::array<int, 3>> front, back;
  for (std::size_t i = 0; i < bounded.size(); ++i) {
    const bool moves = std::binary_search(split.dynamic.begin(), split.dynamic.end(), bounded[i]);
    (moves ? back : front).push_back(surface.triangles[i]);
  }
  const auto count = static_cast<int>(front.size());
  front.insert(front.end(), back.begin(), back.end());
  surface.triangles = std::move(front);
  return count;
}

std::vector<Dof> free_dofs(const DofMap& dofs, const SurfaceMap& surface, int begin, int end) {
  std::vector<Dof> result;
  for (int i = begin; i < end; ++i)
    for (int axis = 0; axis < 3; ++axis)
      if (dofs.is_free(surface.node_number[i], axis)) result.push_back({i, axis});
  return result;
}

std::vector<Dof> of_mesh(const SurfaceMap& surface, std::vector<Dof> dofs) {
  for (Dof& dof : dofs) dof.node = surface.node_number[dof.node];
  return dofs;
}

/// Mesh nodes of the dofs, each once.
std::vector<int> nodes_of(const SurfaceMap& surface, const std::vector<Dof>& dofs) {
  std::vector<int> nodes;
  for (const Dof& dof : dofs)
    if (nodes.empty() || nodes.back() != surface.node_number[dof.node]) nodes.push_back(surface.node_number[dof.node]);
  return nodes;
}

void add_compliance(const HybridSplit& split, const MaterialField& materials, const Progress& progress,
                    Archive& archive) {
  if (archive.touchable_dofs.empty()) return;
  auto compliance = surface_compliance(split.quasi_static_mesh, materials, split.inner,
                                       nodes_of(archive.surface, archive.touchable_dofs),
                                       nodes_of(archive.surface, archive.other_dofs), progress);
  archive.touchable_compliance = std::move(compliance.touchable);
  archive.other_compliance = std::move(compliance.other);
}

void add_hybrid(const Body& body, const TetMesh& mesh, const HybridSplit& split, const MaterialField& whole,
                const std::vector<int>& index, const Progress& progress, Archive& archive) {
  Stopwatch watch(progress);
  const auto materials = materials_of(whole, split.quasi_static);
  SurfaceMap& surface = archive.surface;
  HybridTensors tensors;
  tensors.held_by_connection = split.held_by_connection;
  tensors.quasi_static_triangles = quasi_static_first(mesh, split, surface);
  tensors.interface = interface_faces(mesh, split, index);
  archive.touchable_dofs = free_dofs(split.inner, surface, 0, surface.touchable);
  archive.other_dofs = free_dofs(split.inner, surface, surface.touchable, surface.size());
  const auto mass = lumped_mass(split, materials);
  for (int i = 0; i < surface.size(); ++i) {
    const int node = surface.node_number[i];
    if (!split.connection[node]) continue;
    tensors.connection.push_back(i);
    tensors.mass.push_back(mass[node]);
    for (int axis = 0; axis < 3; ++axis)
      if (split.free.is_free(node, axis)) tensors.dofs.push_back({i, axis});
  }
  watch.lap("connection");

  auto rows = archive.touchable_dofs;
  rows.insert(rows.end(), archive.other_dofs.begin(), archive.other_dofs.end());
  condense_on_connection(split, materials, of_mesh(surface, rows), of_mesh(surface, tensors.dofs), mass,
                         body.dynamic.gravity, tensors);
  watch.lap("condensation on the connection nodes");
  add_compliance(split, materials, progress, archive);
  archive.hybrid = std::move(tensors);
}

/// The dynamic tetrahedra and, at a partial connection, what the two meshes make together.
struct Parts {
  TetMesh mesh;
  std::vector<int> dynamic;
};

Parts find_parts(const Body& body, const TetMesh& mesh, const TetMesh* coarse) {
  if (body.model != "hybrid") {
    std::vector<int> all(mesh.tetrahedra.size());
    std::iota(all.begin(), all.end(), 0);
    return {mesh, all};
  }
  if (!body.hybrid) throw std::runtime_error(fmt::format("body '{}': a hybrid body needs [body.hybrid]", body.name));
  if (!coarse) return {mesh, dynamic_elements(body, mesh)};
  Parts parts{join_meshes(mesh, *coarse, fmt::format("body '{}': [body.hybrid]", body.name)), {}};
  parts.dynamic.resize(coarse->tetrahedra.size());
  std::iota(parts.dynamic.begin(), parts.dynamic.end(), static_cast<int>(mesh.tetrahedra.size()));
  return parts;
}

}  // namespace

Archive precompute_dynamic(const Body& body, const TetMesh& mesh, const TetMesh* coarse, const Progress& progress) try {
  Stopwatch watch(progress);
  const auto parts = find_parts(body, mesh, coarse);
  const auto dofs = apply_fixation(parts.mesh, body.fixed, fmt::format("body '{}'", body.name));
  const auto materials = material_field(body, parts.mesh);
  auto archive = start_archive(body, parts.mesh, materials);
  const auto index = add_moving_part(body, parts.mesh, dofs, materials, parts.dynamic, archive);
  watch.lap("surface");
  if (body.model == "hybrid") {
    const auto split = split_hybrid(body, parts.mesh, dofs, parts.dynamic);
    add_hybrid(body, parts.mesh, split, materials, index, progress, archive);
    if (coarse) add_gap(parts.mesh, split, index, *archive.hybrid);
  }
  return archive;
} catch (const std::bad_alloc&) {
  throw std::runtime_error(fmt::format("body '{}': not enough memory for its tensors", body.name));
}

}  // namespace palpate
