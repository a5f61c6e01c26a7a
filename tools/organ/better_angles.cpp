#include "tools/organ/better_angles.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <vector>

#include "common/mesh/normals.hpp"
#include "common/mesh/surface.hpp"
#include "tools/organ/angles_around.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kSweeps = 12;
constexpr double kReach = 0.25;    // of the shortest edge at a node
constexpr double kLastStep = 0.1;  // of the reach: steps are halved down to it
constexpr double kGain = 0.01;     // [degrees] by which a place is better, so that steps end
constexpr double kSmooth = 0.8;    // cosine between a triangle's normal and its node's where the surface is smooth

/// Where a node may go: nowhere, along a plane, anywhere.
enum class Freedom { none, plane, all };

class Bettering {
 public:
  explicit Bettering(FilledSolid& filled)
      : mesh_(filled.mesh), start_(mesh_.nodes), angles_(mesh_), freedom_(mesh_.nodes.size(), Freedom::all) {
    keep_to_surface();
    for (int n = 0; n < nodes(); ++n) {
      const auto around = angles_.tetrahedra(n);
      if (std::ranges::any_of(around, [&](int t) { return filled.part[t] != filled.part[around[0]]; }))
        freedom_[n] = Freedom::none;
    }
  }

  bool sweep(double wanted) {
    bool moved = false;
    for (int n = 0; n < nodes(); ++n)
      if (freedom_[n] != Freedom::none && angles_.least(n) < wanted) moved |= better(n);
    return moved;
  }

 private:
  int nodes() const { return static_cast<int>(mesh_.nodes.size()); }

  void keep_to_surface() {
    const Surface surface = extract_surface(mesh_);
    normals_.resize(mesh_.nodes.size());
    vertex_normals(mesh_.nodes, surface.triangles, normals_);
    for (const int n : surface.nodes) freedom_[n] = Freedom::plane;
    for (const auto& t : surface.triangles) {
      const Vector3d& a = mesh_.nodes[t[0]];
      const Vector3d normal = (mesh_.nodes[t[1]] - a).cross(mesh_.nodes[t[2]] - a).normalized();
      for (const int n : t)
        if (normal.dot(normals_[n]) < kSmooth) freedom_[n] = Freedom::none;
    }
  }

  double shortest_edge(int n) const {
    double shortest = std::numeric_limits<double>::infinity();
    for (const int t : angles_.tetrahedra(n))
      for (const int other : mesh_.tetrahedra[t])
        if (other != n) shortest = std::min(shortest, (start_[other] - start_[n]).norm());
    return shortest;
  }

  /// Goes step by step to the best of the places around it, along the axes and the diagonals.
  bool better(int n) {
    const double reach = kReach * shortest_edge(n);
    double best = angles_.least(n);
    bool moved = false;
    for (double step = reach / 2; step > kLastStep * reach;) {
      const Vector3d from = mesh_.nodes[n];
      Vector3d place = from;
      for (int i = 0; i < 27; ++i) {
        const int x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1;
        Vector3d way(x, y, z);
        if (freedom_[n] == Freedom::plane) way -= way.dot(normals_[n]) * normals_[n];
        mesh_.nodes[n] = from + step * way.stableNormalized();
        if ((mesh_.nodes[n] - start_[n]).norm() > reach) continue;
        if (const double angle = angles_.least(n); angle > best + kGain) best = angle, place = mesh_.nodes[n];
      }
      mesh_.nodes[n] = place;
      if (place == from) step /= 2;
      moved |= place != from;
    }
    return moved;
  }

  TetMesh& mesh_;
  const std::vector<Vector3d> start_;
  const AnglesAround angles_;
  std::vector<Freedom> freedom_;
  std::vector<Vector3d> normals_;  ///< of the outer surface, at its nodes
};

}  // namespace

void better_angles(double wanted, FilledSolid& filled) {
  Bettering bettering(filled);
  for (int i = 0; i < kSweeps && bettering.sweep(wanted); ++i) continue;
}

}  // namespace palpate
