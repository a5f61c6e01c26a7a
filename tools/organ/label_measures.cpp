#include "tools/organ/label_measures.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/mesh/measures.hpp"
#include "common/mesh/surface.hpp"
#include "tools/organ/mesh_pieces.hpp"
#include "tools/organ/surface_library.hpp"
#include "tools/organ/voxel_pieces.hpp"

namespace palpate {
namespace {

constexpr double kVolumeOff = 0.01;  // of the voxels', above which it is warned of

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

/// How far a label's border and its part's surface, where it touches another part too, are apart.
void tell_distance(const Solid& solid, const GridShape& shape, const std::vector<char>& inside, const TetMesh& part,
                   Output& out, Output::Json& figures) {
  const Surface surface = extract_surface(part);
  const SurfaceTree tree({part.nodes, surface.triangles});
  const DistanceGrid voxels = distance_to_border(shape, inside);
  const double diagonal = shape.spacing.norm();
  Largest largest;
  std::vector<double> distances;
  for (const Eigen::Vector3d& x : border_of(shape, inside)) {
    distances.push_back(tree.distance(x));
    largest.note(distances.back(), x);
  }
  for (const auto& [a, b, c] : surface.triangles)
    over_triangle({part.nodes[a], part.nodes[b], part.nodes[c]}, 0.5 * diagonal,
                  [&](const Eigen::Vector3d& x) { largest.note(std::abs(voxels.at(x)), x); });
  const double mean = std::reduce(distances.begin(), distances.end()) / static_cast<double>(distances.size());
  const auto nearly_all = distances.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(distances.size()));
  std::ranges::nth_element(distances, nearly_all);
  out.say(
      fmt::format("    from its voxels: mean {:.3g} mm, 99 % within {:.3g}, largest {:.3g} at {}; in voxel diagonals "
                  "{:.2f}, {:.2f}, {:.2f}",
                  1e3 * mean, 1e3 * *nearly_all, 1e3 * largest.distance, place_in_mm(solid.in_world(largest.place)),
                  mean / diagonal, *nearly_all / diagonal, largest.distance / diagonal));
  figures.update({{"mean_distance_m", mean},
                  {"distance_of_99_percent_m", *nearly_all},
                  {"largest_distance_m", largest.distance},
                  {"voxel_diagonal_m", diagonal}});
}

std::string say(int pieces, const Topology& t) {
  return fmt::format("{} piece{}, {} closed surface{}, genus {}", pieces, pieces == 1 ? "" : "s", t.surfaces,
                     t.surfaces == 1 ? "" : "s", t.handles);
}

Output::Json json_of(const Topology& t) {
  return {{"closed_surfaces", t.surfaces}, {"genus", t.handles}};
}

void tell_part(const Solid& solid, const LabelVoxels& voxels, int label, const TetMesh& part, double wanted,
               Output& out) {
  const std::string& name = voxels.labels[label].name;
  const std::vector<char>& inside = voxels.inside[label];
  const double volume = measures_of(part).volume;
  const int pieces = static_cast<int>(pieces_of(part).size());
  const Topology of_mesh = topology_of(part);
  const VoxelTopology of_voxels = topology_of(voxels.shape, inside);
  const std::string made = say(pieces, of_mesh), meant = say(of_voxels.pieces_apart, of_voxels.apart);
  out.say(fmt::format("  '{}': {:.4g} ml, of its voxels {:.4g} ml ({:+.2f} %); {}; its voxels: {}", name, 1e6 * volume,
                      1e6 * wanted, 100 * (volume / wanted - 1), made, meant));
  Output::Json& figures =
      out.mesh()["labels"].emplace_back(Output::Json{{"name", name},
                                                     {"volume_m3", volume},
                                                     {"volume_of_voxels_m3", wanted},
                                                     {"pieces", pieces},
                                                     {"pieces_of_voxels", of_voxels.pieces_apart},
                                                     {"topology", json_of(of_mesh)},
                                                     {"topology_of_voxels", json_of(of_voxels.apart)}});
  tell_distance(solid, voxels.shape, inside, part, out, figures);
  if (const double off = volume / wanted - 1; std::abs(off) > kVolumeOff)
    out.warn(fmt::format("the volume of '{}' is {:.3g} % {} than that of its voxels: ask for more nodes", name,
                         100 * std::abs(off), off > 0 ? "more" : "less"));
  if (!of_voxels.allows(of_mesh) || !of_voxels.allows_pieces(pieces))
    out.warn(
        fmt::format("'{}' has {}, and its voxels have {}: a wall or a gap is lost, or a hole made; ask for less "
                    "--smoothing or for more nodes",
                    name, made, meant));
}

}  // namespace

void tell_label_measures(const LabelVoxels& voxels, const std::vector<int>& labels, const LabelSolid& solid,
                         const FilledSolid& filled, Output& out) {
  for (std::size_t p = 0; p < labels.size(); ++p)
    tell_part(solid.solid, voxels, labels[p], part_of(filled, static_cast<int>(p) + 1), solid.volumes[p], out);
}

}  // namespace palpate
