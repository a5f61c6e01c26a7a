#include "common/fem/fine_stiffness.hpp"

#include <algorithm>

#include "common/fem/fine_element.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Lists of nodes that are coupled all with all.
struct Cliques {
  std::vector<std::int64_t> begin{0};
  std::vector<int> node;

  void close() { begin.push_back(static_cast<std::int64_t>(node.size())); }
};

Cliques cliques_of(const FineSpace& space, const Pressures* pressures) {
  Cliques cliques;
  if (!pressures) {
    for (const auto& element : space.elements) {
      cliques.node.insert(cliques.node.end(), element.begin(), element.begin() + space.per_element);
      cliques.close();
    }
    return cliques;
  }
  for (Eigen::Index a = 0; a < pressures->divergence.outerSize(); ++a) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(pressures->divergence, a); it; ++it)
      if (it.row() % 3 == 0) cliques.node.push_back(static_cast<int>(it.row() / 3));
    cliques.close();
  }
  return cliques;
}

/// Blocks of the stiffness, one per entry of the graph, rows the greater node.
struct Blocks {
  const NodeGraph& graph;
  std::vector<Matrix3d> block;

  explicit Blocks(const NodeGraph& graph) : graph(graph), block(graph.neighbour.size(), Matrix3d::Zero()) {}

  Matrix3d& at(int row, int column) {
    const auto* first = graph.neighbour.data();
    return block[std::lower_bound(first + graph.begin[column], first + graph.begin[column + 1], row) - first];
  }
};

void add_elements(const FineSpace& space, const MaterialField& materials, bool dilatation, Blocks& blocks) {
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    const auto points = quadrature(space, e);
    auto constants = lame(materials.at(e / space.children));
    if (!dilatation) constants.lambda = 0;
    const auto& nodes = space.elements[e];
    for (int j = 0; j < space.per_element; ++j)
      for (int k = 0; k < space.per_element; ++k)
        if (nodes[j] >= nodes[k]) blocks.at(nodes[j], nodes[k]) += fine_stiffness_block(points, constants, j, k);
  }
}

void add_pressures(const Pressures& pressures, Blocks& blocks) {
  std::vector<std::pair<int, Vector3d>> star;
  for (Eigen::Index a = 0; a < pressures.divergence.outerSize(); ++a) {
    star.clear();
    for (Eigen::SparseMatrix<double>::InnerIterator it(pressures.divergence, a); it; ++it) {
      if (it.row() % 3 == 0) star.emplace_back(static_cast<int>(it.row() / 3), Vector3d::Zero());
      star.back().second[it.row() % 3] = it.value();
    }
    for (std::size_t k = 0; k < star.size(); ++k)
      for (std::size_t j = k; j < star.size(); ++j)
        blocks.at(star[j].first, star[k].first) += pressures.modulus[a] * star[j].second * star[k].second.transpose();
  }
}

}  // namespace

NodeGraph fine_graph(const FineSpace& space, const Pressures* pressures) {
  const auto cliques = cliques_of(space, pressures);
  const int count = static_cast<int>(space.nodes.size());
  std::vector<std::int64_t> begin(count + 1, 0);
  for (int node : cliques.node) ++begin[node + 1];
  for (int i = 0; i < count; ++i) begin[i + 1] += begin[i];
  std::vector<std::int64_t> member(cliques.node.size());
  auto next = begin;
  for (std::size_t c = 0; c + 1 < cliques.begin.size(); ++c)
    for (auto at = cliques.begin[c]; at < cliques.begin[c + 1]; ++at)
      member[next[cliques.node[at]]++] = static_cast<std::int64_t>(c);

  NodeGraph graph;
  graph.begin.assign(count + 1, 0);
  std::vector<int> seen(count, -1);
  for (int node = 0; node < count; ++node) {
    const auto first = static_cast<std::ptrdiff_t>(graph.neighbour.size());
    for (auto m = begin[node]; m < begin[node + 1]; ++m)
      for (auto at = cliques.begin[member[m]]; at < cliques.begin[member[m] + 1]; ++at) {
        const int other = cliques.node[at];
        if (other < node || seen[other] == node) continue;
        seen[other] = node;
        graph.neighbour.push_back(other);
      }
    std::sort(graph.neighbour.begin() + first, graph.neighbour.end());
    graph.begin[node + 1] = static_cast<std::int64_t>(graph.neighbour.size());
  }
  return graph;
}

SparseMatrix assemble_stiffness(const FineSpace& space, const MaterialField& materials, const Pressures* pressures,
                                const DofMap& dofs, const NodeGraph& graph) {
  Blocks blocks(graph);
  add_elements(space, materials, !pressures, blocks);
  if (pressures) add_pressures(*pressures, blocks);
  return lower_triangle(blocks.block, dofs, graph);
}

std::vector<Vector3d> internal_force(const FineSpace& space, const MaterialField& materials, const Pressures* pressures,
                                     const std::vector<Vector3d>& displacement) {
  std::vector<Vector3d> force(space.nodes.size(), Vector3d::Zero());
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    const auto points = quadrature(space, e);
    const auto constants = lame(materials.at(e / space.children));
    const auto& nodes = space.elements[e];
    for (int q = 0; q < points.count; ++q) {
      Matrix3d gradient = Matrix3d::Zero();
      for (int j = 0; j < space.per_element; ++j) gradient += displacement[nodes[j]] * points.gradient[q].row(j);
      Matrix3d stress = constants.mu * (gradient + gradient.transpose());
      if (!pressures) stress.diagonal().array() += constants.lambda * gradient.trace();
      for (int j = 0; j < space.per_element; ++j)
        force[nodes[j]] += points.weight * stress * points.gradient[q].row(j).transpose();
    }
  }
  if (!pressures) return force;
  Eigen::Map<Eigen::VectorXd>(force[0].data(), pressures->divergence.rows()) +=
      pressures->divergence * (*pressures)(displacement);
  return force;
}

}  // namespace palpate
