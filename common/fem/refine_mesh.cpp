#include "common/fem/refine_mesh.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace palpate {
namespace {

/// The three diagonals of the octahedron between edge midpoints, each with the ring of the other four about it.
constexpr int kDiagonals[3][2] = {{0, 5}, {1, 4}, {2, 3}};
constexpr int kRings[3][4] = {{1, 2, 4, 3}, {0, 3, 5, 2}, {0, 1, 5, 4}};

bool is_positive(const std::vector<Eigen::Vector3d>& nodes, const std::array<int, 4>& tet) {
  Eigen::Matrix3d edges;
  for (int j = 0; j < 3; ++j) edges.col(j) = nodes[tet[j + 1]] - nodes[tet[0]];
  return edges.determinant() > 0;
}

int shortest_diagonal(const std::vector<Eigen::Vector3d>& nodes, const std::array<int, 6>& middle) {
  const auto length = [&](int d) {
    return (nodes[middle[kDiagonals[d][0]]] - nodes[middle[kDiagonals[d][1]]]).squaredNorm();
  };
  int shortest = 0;
  for (int d = 1; d < 3; ++d)
    if (length(d) < length(shortest)) shortest = d;
  return shortest;
}

}  // namespace

EdgeNumbers::EdgeNumbers(const TetMesh& mesh) : first_(mesh.nodes.size()) {
  const auto graph = node_graph(mesh);
  ends_.reserve(graph.neighbour.size());
  for (int node = 0; node < static_cast<int>(mesh.nodes.size()); ++node) {
    first_[node] = static_cast<int>(ends_.size());
    for (auto at = graph.begin[node]; at < graph.begin[node + 1]; ++at)
      if (graph.neighbour[at] != node) ends_.push_back({node, graph.neighbour[at]});
  }
}

int EdgeNumbers::operator()(int a, int b) const {
  const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
  return static_cast<int>(std::lower_bound(ends_.begin() + first_[edge[0]], ends_.end(), edge) - ends_.begin());
}

RefinedMesh split_in_eight(const TetMesh& mesh) {
  const EdgeNumbers edges(mesh);
  const int first = static_cast<int>(mesh.nodes.size());
  RefinedMesh fine{{mesh.nodes, {}, {}}, edges.ends()};
  auto& nodes = fine.mesh.nodes;
  nodes.reserve(first + edges.count());
  for (const auto& [a, b] : edges.ends()) nodes.push_back(0.5 * (mesh.nodes[a] + mesh.nodes[b]));

  auto& children = fine.mesh.tetrahedra;
  children.reserve(8 * mesh.tetrahedra.size());
  for (const auto& tet : mesh.tetrahedra) {
    std::array<int, 6> middle;
    for (int e = 0; e < 6; ++e) middle[e] = first + edges(tet[kTetEdges[e][0]], tet[kTetEdges[e][1]]);
    const auto [m01, m02, m03, m12, m13, m23] = middle;
    children.push_back({tet[0], m01, m02, m03});
    children.push_back({m01, tet[1], m12, m13});
    children.push_back({m02, m12, tet[2], m23});
    children.push_back({m03, m13, m23, tet[3]});
    const int diagonal = shortest_diagonal(nodes, middle);
    for (int i = 0; i < 4; ++i) {
      const auto& ring = kRings[diagonal];
      std::array<int, 4> child{middle[kDiagonals[diagonal][0]], middle[kDiagonals[diagonal][1]], middle[ring[i]],
                               middle[ring[(i + 1) % 4]]};
      if (!is_positive(nodes, child)) std::swap(child[2], child[3]);
      children.push_back(child);
    }
  }
  return fine;
}

}  // namespace palpate
