#include "common/models/hybrid/precompute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "common/fem/body_loads.hpp"
#include "common/fem/lumped_mass.hpp"
#include "common/fem/stopwatch.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/surface.hpp"
#include "common/models/hybrid/hybrid_condensation.hpp"
#include "common/models/hybrid/hybrid_split.hpp"
#include "common/models/hybrid/join_meshes.hpp"
#include "common/models/moving/precompute.hpp"
#include "common/models/solid/precompute.hpp"

namespace palpate {
namespace {

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

/// [N] Per mesh node: the weight of the quasi-static part, and dead loads on what is of this part alone.
std::vector<Eigen::Vector3d> load_of_quasi_static(const HybridSpec& body, const TetMesh& mesh, const HybridSplit& split,
                                                  const std::vector<double>& mass) {
  auto load = force_vector(body_loads(body, mesh), mesh.nodes);
  for (const int e : split.dynamic)
    for (const int node : mesh.tetrahedra[e]) load[node].setZero();
  for (std::size_t n = 0; n < load.size(); ++n) load[n] += mass[n] * body.dynamic.gravity;
  return load;
}

void add_hybrid(const HybridSpec& body, const TetMesh& mesh, const HybridSplit& split, const MaterialField& whole,
                const std::vector<int>& index, const Progress& progress, Archive& archive) {
  Stopwatch watch(progress);
  const auto materials = materials_of(whole, split.quasi_static);
  SurfaceMap& surface = archive.surface;
  CondensedTensors tensors;
  tensors.held_by_connection = split.held_by_connection;
  tensors.quasi_static_triangles = quasi_static_first(mesh, split, surface);
  tensors.interface = interface_faces(mesh, split, index);
  archive.touchable_dofs = free_dofs(split.inner, surface, 0, surface.touchable);
  archive.other_dofs = free_dofs(split.inner, surface, surface.touchable, surface.size());
  const auto mass = lumped_mass(split.quasi_static_mesh, materials);
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
                         load_of_quasi_static(body, mesh, split, mass), tensors);
  watch.lap("condensation on the connection nodes");
  add_compliance(split, materials, progress, archive);
  archive.condensed = std::move(tensors);
  archive.parts.condensed = true;
}

}  // namespace

HybridParts find_parts(const HybridSpec& body, const TetMesh& mesh, const TetMesh* coarse) {
  if (!coarse) return {mesh, dynamic_elements(body, mesh)};
  HybridParts parts{join_meshes(mesh, *coarse, fmt::format("body '{}': [body.hybrid]", body.name)), {}};
  parts.dynamic.resize(coarse->tetrahedra.size());
  std::iota(parts.dynamic.begin(), parts.dynamic.end(), static_cast<int>(mesh.tetrahedra.size()));
  return parts;
}

Archive precompute(const HybridSpec& body, const TetMesh& mesh, const TetMesh* coarse, const Progress& progress) try {
  Stopwatch watch(progress);
  const auto parts = find_parts(body, mesh, coarse);
  const auto dofs = apply_boundary_conditions(parts.mesh, body.fixed, fmt::format("body '{}'", body.name));
  const auto materials = material_field(body, parts.mesh);
  auto archive = start_archive(body, HybridSpec::kKind, parts.mesh, materials);
  const auto index = add_moving_part(body, parts.mesh, dofs, materials, parts.dynamic, archive);
  watch.lap("surface");
  const auto split = split_hybrid(body, parts.mesh, dofs, parts.dynamic);
  add_hybrid(body, parts.mesh, split, materials, index, progress, archive);
  add_compliance_at_rest(parts.mesh, dofs, with_elements(body, parts.dynamic, parts.mesh, materials), progress,
                         archive);
  if (coarse) add_gap(parts.mesh, split, index, *archive.condensed);
  return archive;
} catch (const std::bad_alloc&) {
  throw std::runtime_error(fmt::format("body '{}': not enough memory for its tensors", body.name));
}

ArchiveJob archive_job(const HybridSpec& body, const Progress& progress) {
  return [&, mesh = load_tet_mesh(body.mesh, body.scale)] {
    if (body.hybrid.mesh.empty()) return precompute(body, mesh, nullptr, progress);
    const auto coarse = load_tet_mesh(body.hybrid.mesh, body.hybrid.scale);
    return precompute(body, mesh, &coarse, progress);
  };
}

std::vector<std::string> archive_lines(const HybridSpec& body, const Archive& archive) {
  std::vector<std::string> lines = archive_lines(static_cast<const MovingSpec&>(body), archive);
  const CondensedTensors& hybrid = *archive.condensed;
  lines.push_back(fmt::format("{} connection nodes to the quasi-static part", hybrid.connection.size()));
  if (hybrid.held_by_connection)
    lines.emplace_back("a piece of the quasi-static part has too few fixed nodes: the connection nodes hold it");
  if (!hybrid.gap.empty())
    lines.push_back(
        fmt::format("partial connection: {} nodes of the border are not shared, the gap is up to {:.3g} m at rest",
                    hybrid.gap.size(), hybrid.max_gap));
  return lines;
}

}  // namespace palpate
