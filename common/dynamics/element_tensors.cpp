#include "common/dynamics/element_tensors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/dynamics/stability.hpp"

namespace palpate {
namespace {

constexpr std::array<std::array<int, 2>, 6> kCornerPairs{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

int corner_of(const std::array<int, 4>& tetrahedron, int node) {
  return static_cast<int>(std::find(tetrahedron.begin(), tetrahedron.end(), node) - tetrahedron.begin());
}

}  // namespace

ElementTensors::ElementTensors(const ElasticMesh& mesh)
    : tetrahedra_(mesh.tetrahedra),
      alive_(mesh.tetrahedra.size(), 1),
      material_of_(mesh.material_of),
      around_node_(incidence(mesh.tetrahedra, mesh.nodes())) {
  for (const Material& material : mesh.materials) {
    lame_.push_back(palpate::lame(material));
    density_.push_back(material.density);
  }
  gradients_.reserve(tetrahedra_.size());
  for (int t = 0; t < size(); ++t) {
    const auto& [a, b, c, d] = tetrahedra_[t];
    const TetGradients tet = tet_gradients({mesh.rest[a], mesh.rest[b], mesh.rest[c], mesh.rest[d]});
    if (!(tet.volume > 0)) throw std::runtime_error(fmt::format("tetrahedron {} is flat or inverted", t));
    if (!(density(t) > 0)) throw std::runtime_error(fmt::format("tetrahedron {} has no positive density", t));
    gradients_.push_back(tet);
    frequency_squared_ = std::max(frequency_squared_, element_frequency_squared(tet, lame(t), density(t)));
  }
  find_edges();
}

void ElementTensors::find_edges() {
  edges_.reserve(6 * tetrahedra_.size());
  for (const auto& tet : tetrahedra_)
    for (const auto& [i, j] : kCornerPairs) edges_.push_back({std::min(tet[i], tet[j]), std::max(tet[i], tet[j])});
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  edges_.shrink_to_fit();
  edges_of_.resize(tetrahedra_.size());
  for (int t = 0; t < size(); ++t)
    for (int k = 0; k < 6; ++k)
      edges_of_[t][k] = edge_between(tetrahedra_[t][kCornerPairs[k][0]], tetrahedra_[t][kCornerPairs[k][1]]);
  around_edge_ = incidence(edges_of_, static_cast<int>(edges_.size()));
}

int ElementTensors::edge_between(int a, int b) const {
  const Edge edge{std::min(a, b), std::max(a, b)};
  const auto at = std::lower_bound(edges_.begin(), edges_.end(), edge);
  return at != edges_.end() && *at == edge ? static_cast<int>(at - edges_.begin()) : -1;
}

Eigen::Matrix3d ElementTensors::edge_tensor(int edge) const {
  const auto [a, b] = edges_[edge];
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int t : around_edge_.of(edge))
    if (alive_[t])
      sum += stiffness_block(gradients_[t], lame(t), corner_of(tetrahedra_[t], a), corner_of(tetrahedra_[t], b));
  return sum;
}

double ElementTensors::mass(int node) const {
  double sum = 0;
  for (int t : around_node(node))
    if (alive_[t]) sum += density(t) * gradients_[t].volume / 4;
  return sum;
}

bool ElementTensors::has(int node) const {
  const auto around = around_node(node);
  return std::any_of(around.begin(), around.end(), [&](int t) { return alive_[t] != 0; });
}

Eigen::Vector3d ElementTensors::force(int t, int c, const Corners& u) const {
  const TetGradients& tet = gradients_[t];
  return -tet.volume * (element_stress(tet, lame(t), u) * tet.gradient.row(c).transpose());
}

}  // namespace palpate
