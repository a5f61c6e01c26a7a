#include "common/models/moving/tissue_nodes.hpp"

namespace palpate {

void TissueNodes::add_give(std::span<const int> nodes, std::vector<NodeGive>& give) const {
  for (int i = 0; i < static_cast<int>(nodes.size()); ++i)
    give.push_back({i, i, response_.of_node(nodes[i]).asDiagonal()});
}

void TissueNodes::accelerate(std::span<const PatchForce> forces, double dt) {
  for (const PatchForce& f : forces) accelerate(f.node, response_.of_node(f.node).cwiseProduct(f.force), dt);
}

void TissueNodes::accelerate(int node, const Eigen::Vector3d& moved, double dt) {
  model_.set_motion(node, model_.displacement(node) + moved, model_.velocity(node) + moved / dt);
}

}  // namespace palpate
