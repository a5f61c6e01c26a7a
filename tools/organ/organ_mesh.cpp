#include "tools/organ/organ_mesh.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "common/mesh/measures.hpp"
#include "common/mesh/normals.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

constexpr int kTries = 4;             // for a number of nodes
constexpr double kNearEnough = 0.08;  // of the number of nodes
constexpr double kSameVolume = 1e-4;
constexpr double kWorstAngle = 12;  // [degrees] that every mesh has
constexpr double kKeptAngle = 14;   // [degrees] to which moving a node to the surface may lower one
constexpr int kOtherEdges = 5;      // tried where a mesh is no good

MeshSizes sizes_at(const Fineness& f, double edge) {
  const double inside = f.inside > 0 ? f.inside : 2.5 * edge;
  return {edge, std::max(inside, edge), f.deviation > 0 ? f.deviation : edge / 12, f.fine};
}

/// The edge that gives about so many nodes, found on meshes that are not bettered.
double edge_for(const Solid& solid, const SolidMeasures& measures, const Fineness& f,
                const std::function<void(const std::string&)>& say) {
  double edge = std::sqrt(1.5 * measures.area / f.nodes);
  for (int i = 0; i < kTries; ++i) {
    const auto nodes = static_cast<double>(fill_solid(solid, sizes_at(f, edge), false).mesh.nodes.size());
    const double off = nodes / f.nodes;
    if (std::abs(off - 1) < kNearEnough) return edge;
    edge *= std::pow(off, 0.45);
  }
  say(fmt::format("{} nodes are not met: the deviation from the surface and fine places ask for others", f.nodes));
  return edge;
}

/// Puts the surface's nodes where the surface is exactly, as far as the tetrahedra around them stay good.
void project(const Solid& solid, TetMesh& mesh) {
  if (!solid.nearest) return;
  std::vector<std::vector<int>> around(mesh.nodes.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (const int n : mesh.tetrahedra[t]) around[n].push_back(static_cast<int>(t));
  const auto least = [&](int n) {
    double angle = std::numbers::pi;
    for (const int t : around[n]) {
      const auto& nodes = mesh.tetrahedra[t];
      angle = std::min(angle, tet_volume(mesh, nodes) > 0 ? min_dihedral_angle(mesh, nodes) : 0);
    }
    return angle * 180 / std::numbers::pi;
  };
  for (const int n : extract_surface(mesh).nodes) {
    const Eigen::Vector3d before = mesh.nodes[n];
    const double angle = least(n);
    mesh.nodes[n] = solid.nearest(before);
    if (const double now = least(n); now < kKeptAngle && now < angle) mesh.nodes[n] = before;
  }
}

/// Adds to each part's nodes on the outer surface what brings its volume nearer; true once all are right.
bool step_to_volumes(const Surface& surface, const std::vector<double>& volumes, FilledSolid& filled) {
  TetMesh& mesh = filled.mesh;
  std::vector<double> missing = volumes, area(volumes.size(), 0);
  for (std::size_t t = 0; t < filled.part.size(); ++t)
    missing[filled.part[t] - 1] -= tet_volume(mesh, mesh.tetrahedra[t]);
  bool right = true;
  for (std::size_t p = 0; p < volumes.size(); ++p) right = right && std::abs(missing[p]) < kSameVolume * volumes[p];
  if (right) return true;
  std::vector<Eigen::Vector3d> normals(mesh.nodes.size());
  vertex_normals(mesh.nodes, surface.triangles, normals);
  std::vector<double> of_node(mesh.nodes.size(), 0), share(mesh.nodes.size(), 0);
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto& [a, b, c] = surface.triangles[i];
    area[filled.part[surface.tetrahedra[i]] - 1] +=
        0.5 * (mesh.nodes[b] - mesh.nodes[a]).cross(mesh.nodes[c] - mesh.nodes[a]).norm();
  }
  for (std::size_t i = 0; i < surface.triangles.size(); ++i)
    for (const int n : surface.triangles[i]) {
      const int part = filled.part[surface.tetrahedra[i]] - 1;
      of_node[n] += missing[part] / area[part], share[n] += 1;
    }
  for (const int n : surface.nodes) mesh.nodes[n] += of_node[n] / share[n] * normals[n];
  return false;
}

/// Chords of a curved surface lose volume: its nodes are moved along their normals until it is right.
void match_volumes(const std::vector<double>& volumes, FilledSolid& filled) {
  constexpr int kSteps = 8;
  const Surface surface = extract_surface(filled.mesh);
  for (int i = 0; i < kSteps && !step_to_volumes(surface, volumes, filled); ++i) continue;
}

FilledSolid fill_checked(const Solid& solid, const SolidMeasures& measures, const MeshSizes& sizes) {
  FilledSolid filled = fill_solid(solid, sizes);
  project(solid, filled.mesh);
  if (!measures.volumes.empty()) match_volumes(measures.volumes, filled);
  check_tet_mesh(filled.mesh, "the mesh that was made");
  if (const double angle = measures_of(filled.mesh).smallest_angle; angle < kWorstAngle)
    throw std::runtime_error(
        fmt::format("its smallest dihedral angle is {:.1f} degrees, less than {}", angle, kWorstAngle));
  return filled;
}

}  // namespace

FilledSolid make_organ_mesh(const Solid& solid, const SolidMeasures& measures, const Fineness& fineness,
                            const std::function<void(const std::string&)>& say) {
  double edge = fineness.edge;
  if (edge == 0) {
    say(fmt::format("looking for the edge length that gives {} nodes", fineness.nodes));
    edge = edge_for(solid, measures, fineness, say);
  }
  std::string fault;
  for (int i = 0; i < kOtherEdges; ++i, edge *= 0.97) try {
      say(fmt::format("filling it with tetrahedra, at most {:.3g} mm along the surface", 1e3 * edge));
      return fill_checked(solid, measures, sizes_at(fineness, edge));
    } catch (const std::runtime_error& error) {
      fault = error.what();
      say(fault);
    }
  throw std::runtime_error(fmt::format("no good mesh was found: {}; ask for more nodes or a shorter edge", fault));
}

}  // namespace palpate
