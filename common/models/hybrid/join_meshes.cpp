#include "common/models/hybrid/join_meshes.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>
#include <stdexcept>

#include "common/geometry/triangle.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kCoincident = 1e-3;  // share of the mean edge
constexpr double kFacing = -0.5;      // cosine between the normals of boundaries that face each other

double mean_edge(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.tetrahedra)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b) sum += (mesh.nodes[t[a]] - mesh.nodes[t[b]]).norm();
  return sum / (6.0 * static_cast<double>(mesh.tetrahedra.size()));
}

/// Finds the nearest of some nodes within a distance, by their x.
class NodeFinder {
 public:
  NodeFinder(const TetMesh& mesh, std::vector<int> nodes) : mesh_(mesh), nodes_(std::move(nodes)) {
    std::sort(nodes_.begin(), nodes_.end(), [&](int a, int b) { return x(a) < x(b); });
  }
  /// -1 if there is none.
  int find(const Vector3d& point, double distance) const {
    auto at = std::lower_bound(nodes_.begin(), nodes_.end(), point.x() - distance,
                               [&](int node, double limit) { return x(node) < limit; });
    int best = -1;
    for (; at != nodes_.end() && x(*at) <= point.x() + distance; ++at) {
      const double apart = (mesh_.nodes[*at] - point).norm();
      if (apart > distance) continue;
      distance = apart;
      best = *at;
    }
    return best;
  }

 private:
  double x(int node) const { return mesh_.nodes[node].x(); }
  const TetMesh& mesh_;
  std::vector<int> nodes_;
};

void append_groups(const TetMesh& coarse, const std::vector<int>& node_of, int first_tetrahedron, TetMesh& joined) {
  for (const auto& [name, group] : coarse.groups) {
    MeshGroup& into = joined.groups[name];
    for (int node : group.nodes) into.nodes.push_back(node_of[node]);
    std::sort(into.nodes.begin(), into.nodes.end());
    into.nodes.erase(std::unique(into.nodes.begin(), into.nodes.end()), into.nodes.end());
    for (int t : group.tetrahedra) into.tetrahedra.push_back(first_tetrahedron + t);
  }
}

/// A boundary with the normals of its nodes.
struct Side {
  Surface surface;
  std::vector<Vector3d> normal;  ///< unit, outward, per mesh node
};

Side make_side(const TetMesh& whole, const std::vector<int>& elements) {
  TetMesh part;
  part.nodes = whole.nodes;
  for (int e : elements) part.tetrahedra.push_back(whole.tetrahedra[e]);
  Side side{extract_surface(part), std::vector<Vector3d>(whole.nodes.size(), Vector3d::Zero())};
  for (const auto& [a, b, c] : side.surface.triangles) {
    const Vector3d area = (whole.nodes[b] - whole.nodes[a]).cross(whole.nodes[c] - whole.nodes[a]);
    for (int node : {a, b, c}) side.normal[node] += area;
  }
  for (Vector3d& n : side.normal) n.normalize();
  return side;
}

/// Distance of a point from a triangle's box.
double box_distance(const Vector3d& p, const Triangle& t) {
  const Vector3d low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).norm();
}

/// The pairs of one side's nodes with the other side's triangles.
void add_pairs(const TetMesh& mesh, const std::vector<char>& connection, const Side& from, const Side& to, double reach,
               const std::vector<int>& index, CondensedTensors& tensors) {
  for (int node : from.surface.nodes) {
    if (connection[node]) continue;
    const Vector3d& p = mesh.nodes[node];
    double nearest = reach;
    GapPair pair{-1, {}, {}};
    for (const auto& [a, b, c] : to.surface.triangles) {
      const Triangle triangle{mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]};
      if (box_distance(p, triangle) > nearest) continue;
      const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
      if (normal.dot(from.normal[node]) > kFacing) continue;
      const auto closest = closest_point(p, triangle);
      const double apart = std::sqrt(closest.squared_distance);
      if (apart > nearest) continue;
      nearest = apart;
      const Vector3d& w = closest.weights;
      pair = {index[node], {index[a], index[b], index[c]}, {w[0], w[1], w[2]}};
    }
    if (pair.node < 0) continue;
    tensors.gap.push_back(pair);
    tensors.max_gap = std::max(tensors.max_gap, nearest);
  }
}

}  // namespace

TetMesh join_meshes(const TetMesh& fine, const TetMesh& coarse, const std::string& where) {
  const NodeFinder finder(fine, extract_surface(fine).nodes);
  const double distance = kCoincident * mean_edge(coarse);
  TetMesh joined = fine;
  std::vector<int> node_of(coarse.nodes.size(), -1);
  for (int node : extract_surface(coarse).nodes) node_of[node] = finder.find(coarse.nodes[node], distance);
  if (std::count(node_of.begin(), node_of.end(), -1) == static_cast<long>(node_of.size()))
    throw std::runtime_error(where +
                             ": no node of the tensor-mass mesh coincides with a surface node of the body's mesh");
  for (std::size_t node = 0; node < coarse.nodes.size(); ++node) {
    if (node_of[node] >= 0) continue;
    node_of[node] = static_cast<int>(joined.nodes.size());
    joined.nodes.push_back(coarse.nodes[node]);
  }
  for (std::size_t t = 0; t < coarse.tetrahedra.size(); ++t) {
    const auto& c = coarse.tetrahedra[t];
    const std::array<int, 4> tet{node_of[c[0]], node_of[c[1]], node_of[c[2]], node_of[c[3]]};
    if (std::set<int>(tet.begin(), tet.end()).size() < 4 || tet_volume(joined, tet) <= 0)
      throw std::runtime_error(
          fmt::format("{}: tetrahedron {} of the tensor-mass mesh collapses where nodes coincide", where, t));
    joined.tetrahedra.push_back(tet);
  }
  append_groups(coarse, node_of, static_cast<int>(fine.tetrahedra.size()), joined);
  return joined;
}

void add_gap(const TetMesh& joined, const HybridSplit& split, const std::vector<int>& index,
             CondensedTensors& tensors) {
  TetMesh moving;
  moving.nodes = joined.nodes;
  for (int e : split.dynamic) moving.tetrahedra.push_back(joined.tetrahedra[e]);
  const double reach = 0.5 * mean_edge(moving);
  const Side dynamic = make_side(joined, split.dynamic), quasi_static = make_side(joined, split.quasi_static);
  add_pairs(joined, split.connection, dynamic, quasi_static, reach, index, tensors);
  add_pairs(joined, split.connection, quasi_static, dynamic, reach, index, tensors);
}

}  // namespace palpate
