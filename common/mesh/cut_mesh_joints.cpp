// How a cut mesh hangs on a larger body: through faces, or not at all.
#include <algorithm>

#include "common/mesh/cut_mesh.hpp"

namespace palpate {

void CutMesh::join(std::span<const int> facets) {
  is_joint_.assign(4 * tetrahedra_.size(), 0);
  is_joint_node_.assign(alive_around_.size(), 0);
  joint_edges_.clear();
  for (int id : facets) {
    is_joint_[id] = 1;
    const std::array<int, 3> nodes = facet(id);
    for (int v = 0; v < 3; ++v) {
      is_joint_node_[nodes[v]] = 1;
      const auto [low, high] = std::minmax(nodes[v], nodes[(v + 1) % 3]);
      joint_edges_.push_back({low, high});
    }
  }
  std::sort(joint_edges_.begin(), joint_edges_.end());
  joint_edges_.erase(std::unique(joint_edges_.begin(), joint_edges_.end()), joint_edges_.end());
  joined_.reserve(tetrahedra_.size());
}

/// Removes what hangs on the body at this node, or at an edge of it, without a face.
bool CutMesh::drop_unjoined(int node) {
  if (!has_node(node)) return false;
  if (drop_unjoined(node, -1)) return true;
  for (int t : around_node(node)) {
    if (!alive_[t]) continue;
    for (int other : tetrahedra_[t]) {
      const auto [low, high] = std::minmax(node, other);
      const bool is_joint_edge =
          other != node && std::binary_search(joint_edges_.begin(), joint_edges_.end(), std::array{low, high});
      if (is_joint_edge && drop_unjoined(node, other)) return true;
    }
  }
  return false;
}

/// Removes the groups around the node, or around its edge to `other`, of which no joint holds the node or the edge.
bool CutMesh::drop_unjoined(int node, int other) {
  gather(node, other);
  joined_.assign(group_size_.size(), 0);
  for (int t : star_)
    for (int f = 0; f < 4; ++f)
      if (is_joint_[4 * t + f] && tetrahedra_[t][f] != node && tetrahedra_[t][f] != other) joined_[group_[t]] = 1;
  bool dropped = false;
  for (int t : star_) {
    if (joined_[group_[t]]) continue;
    kill(t);
    dropped = true;
  }
  return dropped;
}

}  // namespace palpate
