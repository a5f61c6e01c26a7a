#include "tools/organ/label_measures.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/mesh/measures.hpp"
#include "common/mesh/surface.hpp"
#include "tools/organ/mesh_pieces.hpp"
#include "tools/organ/surface_library.hpp"
#include "tools/organ/voxel_pieces.hpp"

namespace palpate {
namespace {

/// The largest of distances, and where.
struct Largest {
  double distance = 0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();

  void note(double d, const Eigen::Vector3d& x) {
    if (d > distance) distance = d, place = x;
  }
};

/// Calls look(x) on points of a triangle at most `step` [m] apart.
template <class Look>
void over_triangle(const std::array<Eigen::Vector3d, 3>& corners, double step, const Look& look) {
  const Eigen::Vector3d u = corners[1] - corners[0], v = corners[2] - corners[0];
  const int n = static_cast<int>(std::ceil(std::max({u.norm(), v.norm(), (u - v).norm()}) / step));
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j) look(corners[0] + (i * u + j * v) / n);
}

void print_distance(const LabelSolid& labels, const TetMesh& mesh, const Eigen::Vector3d& voxel) {
  const Surface surface = extract_surface(mesh);
  const SurfaceTree tree({mesh.nodes, surface.triangles});
  const double diagonal = voxel.norm();
  double sum = 0;
  Largest largest;
  for (const Eigen::Vector3d& x : labels.border) {
    const double distance = tree.distance(x);
    sum += distance;
    largest.note(distance, x);
  }
  for (const auto& [a, b, c] : surface.triangles)
    over_triangle({mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]}, 0.5 * diagonal,
                  [&](const Eigen::Vector3d& x) { largest.note(labels.from_voxels(x), x); });
  const double mean = sum / static_cast<double>(labels.border.size());
  fmt::print(
      "  surface to voxels: mean {:.3g} mm, largest {:.3g} mm, which are {:.2f} and {:.2f} voxel diagonals, at {}\n",
      1e3 * mean, 1e3 * largest.distance, mean / diagonal, largest.distance / diagonal, place_in_mm(largest.place));
}

std::string say(const Topology& t) {
  return fmt::format("{} closed surface{}, genus {}", t.surfaces, t.surfaces == 1 ? "" : "s", t.handles);
}

}  // namespace

void print_label_measures(const LabelVoxels& voxels, const std::vector<int>& labels, const LabelSolid& solid,
                          const FilledSolid& filled) {
  for (std::size_t p = 0; p < labels.size(); ++p) {
    const TetMesh part = part_of(filled, static_cast<int>(p) + 1);
    const double volume = measures_of(part).volume;
    const auto pieces = pieces_of(part).size();
    fmt::print("  '{}': {:.4g} ml, of its voxels {:.4g} ml ({:+.2f} %); {} piece{}, {}; its voxels: {}\n",
               voxels.labels[labels[p]].name, 1e6 * volume, 1e6 * solid.volumes[p],
               100 * (volume / solid.volumes[p] - 1), pieces, pieces == 1 ? "" : "s", say(topology_of(part)),
               say(topology_of(voxels.shape, voxels.inside[labels[p]])));
  }
  print_distance(solid, filled.mesh, voxels.shape.spacing);
}

}  // namespace palpate
