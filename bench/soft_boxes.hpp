#pragma once
#include <array>
#include <random>

#include "common/dynamics/elastic_mesh.hpp"
#include "common/mesh/generators.hpp"

namespace palpate::bench {

/// A box of cells of 5 mm, five tetrahedra each, that hangs on its face x = 0. Nodes are moved at random by
/// up to a tenth of a cell, so that no two blocks of the stiffness are alike.
inline ElasticMesh make_soft_box(const std::array<int, 3>& cells, const Material& material) {
  const double cell = 0.005;
  TetMesh box = make_block_of_five({0, 0, 0}, {cell * cells[0], cell * cells[1], cell * cells[2]}, cells);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> jitter(-0.1 * cell, 0.1 * cell);
  for (auto& x : box.nodes)
    for (int axis = 0; axis < 3; ++axis) x[axis] += jitter(random);
  ElasticMesh mesh{box.nodes, box.tetrahedra, {}, {material}, {}};
  mesh.fixed.resize(box.nodes.size());
  for (int n : box.groups.at("x0").nodes) mesh.fixed[n] = {true, true, true};
  return mesh;
}

/// 760 nodes, 2,220 tetrahedra, 3,521 edges: about the size of RR3510's plate.
inline ElasticMesh make_box760(const Material& material) {
  return make_soft_box({37, 4, 3}, material);
}
/// 10,648 nodes, 46,305 tetrahedra, 59,598 edges.
inline ElasticMesh make_box10648(const Material& material) {
  return make_soft_box({21, 21, 21}, material);
}

}  // namespace palpate::bench
