#include "common/models/quasi_static/precompute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <new>
#include <stdexcept>

#include "common/fem/body_loads.hpp"
#include "common/fem/fine_problem.hpp"
#include "common/fem/specimen.hpp"
#include "common/fem/stopwatch.hpp"
#include "common/fem/surface_columns.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/surface.hpp"
#include "common/models/quasi_static/compress.hpp"
#include "common/models/quasi_static/press_by_laws.hpp"
#include "common/models/solid/precompute.hpp"

namespace palpate {
namespace {

PrecomputeCost add_dense(const QuasiStaticSpec& body, const StaticProblem& problem, Route route,
                         const Progress& progress, Archive& archive) {
  const auto& [mesh, materials, dofs] = problem;
  const SurfaceMap& surface = archive.surface;
  const auto split = surface.node_number.begin() + surface.touchable;
  const std::vector<int> touchable(surface.node_number.begin(), split), other(split, surface.node_number.end());
  auto compliance = is_finer(body.offline)
                        ? surface_compliance(make_fine_problem(mesh, *body.offline, materials, dofs, body.name),
                                             touchable, other, progress)
                        : surface_compliance(mesh, materials, dofs, touchable, other, progress, route);
  archive.touchable_compliance = std::move(compliance.touchable);
  archive.other_compliance = std::move(compliance.other);
  return {compliance.flops, compliance.condensed};
}

PrecomputeCost add_compressed(const QuasiStaticSpec& body, const StaticProblem& problem, const Progress& progress,
                              Archive& archive) {
  const auto& [mesh, materials, dofs] = problem;
  const std::vector<int>& nodes = archive.surface.node_number;
  const SurfaceColumns columns =
      is_finer(body.offline) ? SurfaceColumns(make_fine_problem(mesh, *body.offline, materials, dofs, body.name), nodes,
                                              3 * compressed_bytes(archive.surface), progress)
                             : SurfaceColumns(mesh, materials, dofs, nodes, progress);
  archive.compressed = compress(archive.surface, std::cref(columns), progress);
  return {columns.flops(), false};
}

/// How its loads and its weight move the surface.
std::vector<Eigen::Vector3d> sag_of(const QuasiStaticSpec& body, const StaticProblem& problem,
                                    const SurfaceMap& surface) {
  const StaticLoads loads = resting_loads(body, problem.mesh);
  if (loads.empty()) return {};
  const auto& [mesh, materials, dofs] = problem;
  const StaticSolution rest =
      is_finer(body.offline)
          ? solve_direct(make_fine_problem(mesh, *body.offline, materials, dofs, body.name), {}, loads)
          : solve_direct(problem, {}, loads);
  std::vector<Eigen::Vector3d> sag;
  for (const int node : surface.node_number) sag.push_back(rest.displacement[node]);
  return sag;
}

}  // namespace

Archive precompute(const QuasiStaticSpec& body, const TetMesh& mesh, const TetMesh* specimen, const Progress& progress,
                   Route route, PrecomputeCost* cost, std::optional<TensorForm> form) try {
  Stopwatch watch(progress);
  const auto dofs = apply_boundary_conditions(mesh, body.fixed, "body '" + body.name + "'");
  const auto materials = material_field(body, mesh);
  auto archive = start_archive(body, QuasiStaticSpec::kKind, mesh, materials);
  archive.surface = make_surface_map(body, mesh, dofs);
  const auto& surface = archive.surface;
  archive.touchable_dofs = free_dofs(surface, 0, surface.touchable);
  archive.other_dofs = free_dofs(surface, surface.touchable, surface.size());
  watch.lap("surface");

  const StaticProblem problem{mesh, materials, dofs};
  archive.sag = sag_of(body, problem, surface);
  const PrecomputeCost spent = form.value_or(form_of(surface.touchable)) == TensorForm::compressed
                                   ? add_compressed(body, problem, progress, archive)
                                   : add_dense(body, problem, route, progress, archive);
  if (cost) *cost = spent;
  if (specimen) {
    Stopwatch specimen_watch(progress);
    const auto slopes = press_specimen(*specimen, body.material, body.offline);
    archive.specimen_force_slope = slopes.force;
    archive.specimen_radial_slope = slopes.radial;
    specimen_watch.lap("specimen");
  }
  if (const auto* law = law_of<NeoHookeanLaw>(body.nonlinear))
    archive.presses = press_by_laws(problem, surface, *law, body.name, progress);
  return archive;
} catch (const std::bad_alloc&) {
  throw std::runtime_error(fmt::format("body '{}': not enough memory for its tensors", body.name));
}

StaticLoads resting_loads(const QuasiStaticSpec& body, const TetMesh& mesh) {
  StaticLoads loads = body_loads(body, mesh);
  loads.gravity = body.gravity;
  return loads;
}

std::optional<TetMesh> load_specimen(const QuasiStaticSpec& body) {
  const auto* law = law_of<MeasuredLaw>(body.nonlinear);
  if (!law || law->specimen_mesh.empty()) return {};
  return load_tet_mesh(law->specimen_mesh, law->specimen_scale);
}

QuasiStaticSpec with_offline(QuasiStaticSpec body, const TetMesh& mesh) {
  std::vector<bool> on_surface(mesh.nodes.size(), false);
  for (const auto& triangle : extract_surface(mesh).triangles)
    for (const int node : triangle) on_surface[node] = true;
  body.offline = offline_of(body, static_cast<int>(std::ranges::count(on_surface, true)));
  return body;
}

ArchiveJob archive_job(const QuasiStaticSpec& body, const Progress& progress) {
  return [&, mesh = load_tet_mesh(body.mesh, body.scale)] {
    const auto specimen = load_specimen(body);
    return precompute(with_offline(body, mesh), mesh, specimen ? &*specimen : nullptr, progress);
  };
}

}  // namespace palpate
