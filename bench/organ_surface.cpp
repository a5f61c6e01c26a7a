// Triangles against distance: marching cubes at several steps beside the surface of `palpate organ` at several
// deviations, both of the level of one smoothed distance, which is taken for the truth. Marching cubes (Lorensen and
// Cline 1987) without its table: crossed edges are linked around each cell's faces, the loops cut into fans, which
// gives the same vertices and, but for faces with two corners inside that touch crosswise, the same number of
// triangles. bench_organ_surface [--quick] [IMAGE LABEL]: of a label in an image, or else of a made body.
#include <Eigen/Geometry>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "bench/report.hpp"
#include "common/mesh/surface.hpp"
#include "tools/organ/label_solid.hpp"
#include "tools/organ/surface_library.hpp"
#include "tools/organ/surface_shells.hpp"

namespace palpate {
namespace {

using Field = std::function<double(const Eigen::Vector3d&)>;

constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

class MarchingCubes {
 public:
  MarchingCubes(const GridShape& shape, const Field& field) : shape_(shape) {
    for (int k = 0; k < shape.count[2]; ++k)
      for (int j = 0; j < shape.count[1]; ++j)
        for (int i = 0; i < shape.count[0]; ++i) value_.push_back(field(shape.place(i, j, k)));
    for (int k = 0; k + 1 < shape.count[2]; ++k)
      for (int j = 0; j + 1 < shape.count[1]; ++j)
        for (int i = 0; i + 1 < shape.count[0]; ++i) cut_cell(i, j, k);
  }
  const TriangleMesh& mesh() const { return mesh_; }

 private:
  void cut_cell(int i, int j, int k) {
    std::array<std::size_t, 8> corner;
    for (int c = 0; c < 8; ++c) corner[c] = shape_.index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
    std::array<int, 64> next;  // from a crossed edge, as 8 a + b of its corners a < b
    next.fill(-1);
    for (const auto& face : kFaces)
      for (int e = 0; e < 4; ++e) {
        const auto inside = [&](int at) { return value_[corner[face[at % 4]]] < 0; };
        const auto edge = [&](int at) {
          const auto [a, b] = std::minmax(face[at % 4], face[(at + 1) % 4]);
          return 8 * a + b;
        };
        if (!inside(e) || inside(e + 1)) continue;
        int back = e;
        while (inside(back + 3)) back += 3;
        next[edge(e)] = edge(back + 3);
      }
    for (int first = 0; first < 64; ++first) {
      std::vector<int> loop;
      for (int at = first; next[at] >= 0;) {
        loop.push_back(vertex(corner[at / 8], corner[at % 8]));
        at = std::exchange(next[at], -1);
      }
      for (std::size_t n = 2; n < loop.size(); ++n) mesh_.triangles.push_back({loop[0], loop[n], loop[n - 1]});
    }
  }

  int vertex(std::size_t a, std::size_t b) {
    const auto [found, is_new] = vertices_.try_emplace(a * value_.size() + b, static_cast<int>(mesh_.nodes.size()));
    if (is_new) {
      const double part = value_[a] / (value_[a] - value_[b]);
      mesh_.nodes.emplace_back(shape_.place_of(a) + part * (shape_.place_of(b) - shape_.place_of(a)));
    }
    return found->second;
  }

  GridShape shape_;
  std::vector<double> value_;
  std::unordered_map<std::size_t, int> vertices_;
  TriangleMesh mesh_;
};

TriangleMesh marching_cubes(const Solid& solid, const Eigen::Vector3d& step) {
  GridShape shape{{}, solid.low, step};
  for (int a = 0; a < 3; ++a) shape.count[a] = static_cast<int>((solid.high[a] - solid.low[a]) / step[a]) + 1;
  return MarchingCubes(shape,
                       [&](const Eigen::Vector3d& x) { return solid.part(x) > 0 ? -solid.depth(x) : solid.depth(x); })
      .mesh();
}

/// Distances both ways between a surface and the level, given by points on it.
void report_surface(const std::string& name, const TriangleMesh& mesh, const Solid& solid,
                    const std::vector<Eigen::Vector3d>& truth) {
  const SurfaceTree tree(mesh);
  double sum = 0, largest = 0;
  for (const Eigen::Vector3d& x : truth) {
    const double distance = tree.distance(x);
    sum += distance, largest = std::max(largest, distance);
  }
  constexpr int kParts = 4;
  for (const auto& [a, b, c] : mesh.triangles)
    for (int i = 0; i <= kParts; ++i)
      for (int j = 0; i + j <= kParts; ++j) {
        const Eigen::Vector3d x = (i * mesh.nodes[a] + j * mesh.nodes[b] + (kParts - i - j) * mesh.nodes[c]) / kParts;
        largest = std::max(largest, (x - solid.nearest(x)).norm());
      }
  bench::report("organ_surface", name, "triangles", static_cast<double>(mesh.triangles.size()), "1");
  bench::report("organ_surface", name, "mean_distance", 1e3 * sum / static_cast<double>(truth.size()), "mm");
  bench::report("organ_surface", name, "largest_distance", 1e3 * largest, "mm");
  bench::report("organ_surface", name, "volume", 1e6 * enclosed_volume(mesh), "ml");
}

TriangleMesh organ_surface(const LabelSolid& labels, double deviation) {
  constexpr double kCoarse = 25;  // deviations: the edge that is asked for where the surface is flat
  const FilledSolid filled =
      make_organ_mesh(labels.solid, labels.measures, {0, kCoarse * deviation, 0, deviation, {}}, [](const auto&) {});
  return {filled.mesh.nodes, extract_surface(filled.mesh).triangles};
}

void compare(const LabelVolume& volume, int label, bool quick) {
  std::vector<Finding> findings;
  const LabelSolid labels = solid_of(voxels_of(volume, {{label, "organ"}}, findings), {0}, {}, findings);
  const Eigen::Vector3d voxel = volume.shape.spacing;
  const TriangleMesh finest = marching_cubes(labels.solid, voxel);
  const std::size_t stride = finest.nodes.size() / 50000 + 1;
  std::vector<Eigen::Vector3d> truth;
  for (std::size_t n = 0; n < finest.nodes.size(); n += stride) truth.push_back(labels.solid.nearest(finest.nodes[n]));
  for (const double step : {1, 2, 3, 4, 6, 8}) {
    if (quick && step < 3) continue;
    report_surface(fmt::format("marching_cubes_{}_voxels", step), marching_cubes(labels.solid, step * voxel),
                   labels.solid, truth);
  }
  for (const double part : {0.15, 0.3, 0.6, 1.2}) {
    if (quick && part < 0.6) continue;
    try {
      report_surface(fmt::format("organ_{}_diagonals", part), organ_surface(labels, part * volume.diagonal()),
                     labels.solid, truth);
    } catch (const std::runtime_error& error) {
      fmt::print(stderr, "organ at {} voxel diagonals: {}\n", part, error.what());
    }
  }
}

/// An ellipsoid with a bump and a dent, of 1 mm voxels.
LabelVolume made_body() {
  LabelVolume volume{{{100, 80, 60}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(1e-3)}, {}};
  for (int k = 0; k < 60; ++k)
    for (int j = 0; j < 80; ++j)
      for (int i = 0; i < 100; ++i) {
        const Eigen::Vector3d x = Eigen::Vector3d(i, j, k) - Eigen::Vector3d(50, 40, 30);
        const bool body = x.cwiseQuotient(Eigen::Vector3d(38, 28, 20)).norm() < 1;
        const bool bump = (x - Eigen::Vector3d(-22, 20, 0)).norm() < 12,
                   dent = (x - Eigen::Vector3d(25, -28, 0)).norm() < 14;
        volume.value.push_back((body || bump) && !dent);
      }
  return volume;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  const bool quick = palpate::bench::quick(argc, argv);
  if (argc > 2 + quick)
    palpate::compare(palpate::read_label_volume(argv[argc - 2]), std::stoi(argv[argc - 1]), quick);
  else
    palpate::compare(palpate::made_body(), 1, quick);
}
