#include "common/models/moving/condensed_nodes.hpp"

#include <algorithm>

namespace palpate {

using Eigen::Map;
using Eigen::Matrix3d;
using Eigen::Vector3d;

CondensedNodes::CondensedNodes(DynamicModel& model, const InertialResponse& response, CondensedPart& part, int patches)
    : TissueNodes(model, response),
      part_(part),
      inertia_(3 * part.connection().size(), 0.0),
      drawn_(3 * part.connection().size(), 0.0) {
  part.expect_patches(patches);
}

Vector3d CondensedNodes::displacement(int node) const {
  return part_.owns(node) ? part_.displacement(node) : model().displacement(node);
}

// Of one that has lost its tetrahedra the mass of the quasi-static ones is left.
Vector3d CondensedNodes::inertia(int connection) const {
  return response().of_mass(part_.connection()[connection],
                            std::max(model().mass(part_.connection()[connection]), part_.mass(connection)));
}

void CondensedNodes::add_give(std::span<const int> nodes, std::vector<NodeGive>& give) const {
  for (std::size_t k = 0; k < part_.connection().size(); ++k)
    Map<Vector3d>(inertia_.data() + 3 * k) = inertia(static_cast<int>(k));
  for (int i = 0; i < static_cast<int>(nodes.size()); ++i)
    for (int j = 0; j <= i; ++j) {
      if (part_.touches(nodes[i]) && part_.touches(nodes[j])) {
        const Matrix3d block = part_.give(nodes[i], nodes[j], inertia_);
        if (i == j || !block.isZero(0)) give.push_back({i, j, block});
      } else if (i == j) {
        give.push_back({i, i, response().of_node(nodes[i]).asDiagonal()});
      }
    }
}

void CondensedNodes::release(int patch) {
  part_.push(patch, {});
  part_.take(model());
}

void CondensedNodes::push(int patch, std::span<const PatchForce> forces, double dt) {
  part_.push(patch, forces);
  part_.draw(patch, drawn_);
  for (std::size_t k = 0; k < part_.connection().size(); ++k) {
    const Map<const Vector3d> force(drawn_.data() + 3 * k);
    if (!force.isZero(0)) accelerate(part_.connection()[k], inertia(static_cast<int>(k)).cwiseProduct(force), dt);
  }
  for (const PatchForce& f : forces)
    if (!part_.touches(f.node)) accelerate(f.node, response().of_node(f.node).cwiseProduct(f.force), dt);
  part_.take(model());
}

void CondensedNodes::resume(int patch, std::span<const PatchForce> forces) {
  part_.push(patch, forces);
}

}  // namespace palpate
