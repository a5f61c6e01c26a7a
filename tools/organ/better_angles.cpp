#include "tools/organ/better_angles.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numbers>
#include <vector>

#include "common/mesh/normals.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kSweeps = 12;
constexpr double kReach = 0.25;    // of the shortest edge at a node
constexpr double kLastStep = 0.1;  // of the reach: steps are halved down to it
constexpr double kSmooth = 0.8;    // cosine between a triangle's normal and its node's where the surface is smooth

/// Where a node may go: nowhere, along a plane, anywhere.
enum class Freedom { none, plane, all };

class Angles {
 public:
  explicit Angles(FilledSolid& filled)
      : mesh_(filled.mesh),
        start_(mesh_.nodes),
        around_(mesh_.nodes.size()),
        freedom_(mesh_.nodes.size(), Freedom::all) {
    for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t)
      for (const int n : mesh_.tetrahedra[t]) around_[n].push_back(static_cast<int>(t));
    keep_to_surface();
    for (std::size_t n = 0; n < around_.size(); ++n)
      if (std::ranges::any_of(around_[n], [&](int t) { return filled.part[t] != filled.part[around_[n][0]]; }))
        freedom_[n] = Freedom::none;
  }

  bool sweep(double wanted) {
    bool moved = false;
    for (std::size_t n = 0; n < around_.size(); ++n)
      if (freedom_[n] != Freedom::none && least(n) < wanted) moved |= better(n);
    return moved;
  }

 private:
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

  /// [degrees] The least angle of the tetrahedra at a node; 0 where one is turned over.
  double least(std::size_t n) const {
    double angle = std::numbers::pi;
    for (const int t : around_[n]) {
      const auto& nodes = mesh_.tetrahedra[t];
      angle = std::min(angle, tet_volume(mesh_, nodes) > 0 ? min_dihedral_angle(mesh_, nodes) : 0);
    }
    return angle * 180 / std::numbers::pi;
  }

  double shortest_edge(std::size_t n) const {
    double shortest = std::numeric_limits<double>::infinity();
    for (const int t : around_[n])
      for (const int other : mesh_.tetrahedra[t])
        if (other != static_cast<int>(n)) shortest = std::min(shortest, (start_[other] - start_[n]).norm());
    return shortest;
  }

  /// Goes step by step to the best of the places around it, along the axes and the diagonals.
  bool better(std::size_t n) {
    const double reach = kReach * shortest_edge(n);
    double best = least(n);
    bool moved = false;
    for (double step = reach / 2; step > kLastStep * reach;) {
      const Vector3d from = mesh_.nodes[n];
      Vector3d place = from;
      for (int i = 0; i < 27; ++i) {
        Vector3d way(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        if (freedom_[n] == Freedom::plane) way -= way.dot(normals_[n]) * normals_[n];
        mesh_.nodes[n] = from + step * way.stableNormalized();
        if ((mesh_.nodes[n] - start_[n]).norm() > reach) continue;
        if (const double angle = least(n); angle > best) best = angle, place = mesh_.nodes[n];
      }
      mesh_.nodes[n] = place;
      if (place == from) step /= 2;
      moved |= place != from;
    }
    return moved;
  }

  TetMesh& mesh_;
  const std::vector<Vector3d> start_;
  std::vector<std::vector<int>> around_;  ///< tetrahedra at each node
  std::vector<Freedom> freedom_;
  std::vector<Vector3d> normals_;  ///< of the outer surface, at its nodes
};

}  // namespace

void better_angles(double wanted, FilledSolid& filled) {
  Angles angles(filled);
  for (int i = 0; i < kSweeps && angles.sweep(wanted); ++i) continue;
}

}  // namespace palpate
