// What does one haptic step spend on finding what the tip meets? A tip of eight sample points wanders over
// the liver's surface, a tenth of a millimetre a step.
//   rest      the buckets are asked and each sample point is swept against what they give
//   deformed  before that the nodes near the tip are superposed from one contact of three nodes, and their
//             triangles moved in the buckets
#include <Eigen/Geometry>
#include <cmath>
#include <exception>
#include <random>

#include "bench/report.hpp"
#include "common/geometry/buckets.hpp"
#include "common/geometry/triangle.hpp"
#include "common/kernels/kernels.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/surface.hpp"

namespace {
using namespace palpate;
using Eigen::Vector3d;

constexpr int kSamples = 8;
constexpr double kTip = 0.004;     // [m] radius
constexpr double kStep = 0.0001;   // [m]
constexpr double kBucket = 0.012;  // [m]
constexpr double kNear = 0.012;    // [m] reach of what is superposed around the tip

/// A smooth field in place of the compliance: what is read matters here, not what it says.
struct Organ {
  explicit Organ(const TetMesh& mesh) {
    const Surface surface = extract_surface(mesh);
    std::vector<int> place(mesh.nodes.size(), -1);
    for (int node : surface.nodes) {
      place[node] = static_cast<int>(rest.size());
      rest.push_back(mesh.nodes[node]);
    }
    for (const auto& t : surface.triangles) triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
    of_node.resize(rest.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (int node : triangles[t]) of_node[node].push_back(static_cast<int>(t));
    stride = (3 * static_cast<std::ptrdiff_t>(rest.size()) + 15) / 16 * 16;
    compliance.resize(stride * 3 * rest.size());
    for (std::size_t k = 0; k < rest.size(); ++k)
      for (std::size_t n = 0; n < rest.size(); ++n)
        for (int axis = 0; axis < 3; ++axis)
          compliance[stride * (3 * k + axis) + 3 * n + axis] = 1e-5 / (0.005 + (rest[n] - rest[k]).norm());
    previous = position = rest;
  }

  Triangle corners(const std::vector<Vector3d>& x, int t) const {
    return {x[triangles[t][0]], x[triangles[t][1]], x[triangles[t][2]]};
  }

  std::vector<Vector3d> rest, previous, position;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::vector<int>> of_node;
  std::ptrdiff_t stride;
  kernels::Buffer compliance;
};

class Collision {
 public:
  explicit Collision(Organ& organ) : organ_(organ), buckets_(organ.rest, organ.triangles, kBucket) {
    found_.resize(organ.triangles.size());
    near_.reserve(organ.rest.size());
    stamp_.assign(organ.rest.size(), 0);
    displacement_.resize(3 * organ.rest.size());
  }

  /// Brings the nodes around the tip to where the force [N] on triangle `touched` holds them.
  void deform(const Vector3d& tip, int touched, const Vector3d& force) {
    list_nodes(tip);
    const double* columns[9];
    double weights[9];
    for (int i = 0; i < 9; ++i) {
      columns[i] = organ_.compliance.data() + organ_.stride * (3 * organ_.triangles[touched][i / 3] + i % 3);
      weights[i] = force[i % 3] / 3;
    }
    const int count = static_cast<int>(near_.size());
    kernels::active().combine_nodes_d(columns, weights, 9, near_.data(), count, displacement_.data());
    for (int i = 0; i < count; ++i) {
      organ_.previous[near_[i]] = organ_.position[near_[i]];
      organ_.position[near_[i]] = organ_.rest[near_[i]] + Eigen::Map<const Vector3d>(&displacement_[3 * i]);
    }
    for (int i = 0; i < count; ++i)
      for (int t : organ_.of_node[near_[i]]) move(t);
  }

  /// Earliest crossing of each sample point on its way; returns how many cross.
  int sweep(const Vector3d& before, const Vector3d& now) {
    int hits = 0;
    for (int sample = 0; sample < kSamples; ++sample) {
      const Vector3d p0 = before + offset(sample), p1 = now + offset(sample);
      const int count = buckets_.query(p0.cwiseMin(p1), p0.cwiseMax(p1), 0, found_);
      double earliest = 2;
      for (int i = 0; i < count; ++i) {
        const auto hit =
            sweep_point(p0, p1, organ_.corners(organ_.previous, found_[i]), organ_.corners(organ_.position, found_[i]));
        if (hit && hit->time < earliest) earliest = hit->time;
      }
      hits += earliest <= 1;
    }
    return hits;
  }

  std::size_t near() const { return near_.size(); }

 private:
  static Vector3d offset(int sample) {
    return kTip / std::sqrt(3.0) * Vector3d(sample & 1 ? 1 : -1, sample & 2 ? 1 : -1, sample & 4 ? 1 : -1);
  }
  void list_nodes(const Vector3d& tip) {
    near_.clear();
    ++clock_;
    const int count = buckets_.query(tip, tip, kNear, found_);
    for (int i = 0; i < count; ++i)
      for (int node : organ_.triangles[found_[i]]) {
        if (stamp_[node] == clock_) continue;
        stamp_[node] = clock_;
        near_.push_back(node);
      }
  }
  void move(int t) {
    const Triangle a = organ_.corners(organ_.previous, t), b = organ_.corners(organ_.position, t);
    buckets_.move(t, a[0].cwiseMin(a[1]).cwiseMin(a[2]).cwiseMin(b[0]).cwiseMin(b[1]).cwiseMin(b[2]),
                  a[0].cwiseMax(a[1]).cwiseMax(a[2]).cwiseMax(b[0]).cwiseMax(b[1]).cwiseMax(b[2]));
  }

  Organ& organ_;
  Buckets buckets_;
  std::vector<int> found_, near_, stamp_;
  std::vector<double> displacement_;
  int clock_ = 0;
};

/// The tip circles into and out of the surface around one triangle after another.
struct Path {
  const Organ& organ;
  int touched(int step) const { return (step / 500 * 37) % static_cast<int>(organ.triangles.size()); }
  Vector3d at(int step) const {
    const Triangle t = organ.corners(organ.rest, touched(step));
    const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized(), along = (t[1] - t[0]).normalized();
    const double angle = 2 * M_PI * (step % 500) / 500, radius = kStep * 500 / (2 * M_PI);
    return (t[0] + t[1] + t[2]) / 3 + radius * (std::cos(angle) * along + std::sin(angle) * normal);
  }
};

void run(const std::string& mesh, bool quick) {
  Organ organ(load_tet_mesh(mesh, 1.0));
  Collision collision(organ);
  const Path path{organ};
  const int count = quick ? 5000 : 100000;
  bench::Samples rest, deformed, nodes;
  long hits = 0;
  const auto shift = [](int i) { return i < 0 ? i + 1000 : i; };
  rest.measure(1000, count, [&](int i) {
    const int step = shift(i);
    hits += collision.sweep(path.at(step), path.at(step / 500 == (step + 1) / 500 ? step + 1 : step));
  });
  bench::report("collision", "liver1400_rest", "p50", 1e6 * rest.median(), "us");
  bench::report("collision", "liver1400_rest", "p999", 1e6 * rest.p999(), "us");
  bench::report("collision", "liver1400_rest", "crossings_per_step", static_cast<double>(hits) / count, "1");
  deformed.measure(1000, count, [&](int i) {
    const int step = shift(i);
    const double press = 0.5 * std::sin(0.01 * step);
    collision.deform(path.at(step), path.touched(step), Vector3d(0.3, -0.2, 1) * press);
    hits += collision.sweep(path.at(step), path.at(step / 500 == (step + 1) / 500 ? step + 1 : step));
    nodes.add(static_cast<double>(collision.near()));
  });
  bench::keep(hits);
  bench::report("collision", "liver1400_deformed", "p50", 1e6 * deformed.median(), "us");
  bench::report("collision", "liver1400_deformed", "p999", 1e6 * deformed.p999(), "us");
  bench::report("collision", "liver1400_deformed", "near_nodes", nodes.median(), "1");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(PALPATE_SCENES "/meshes/liver.msh", palpate::bench::quick(argc, argv));
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_collision: {}\n", error.what());
    return 1;
  }
}
