// How a cut mesh is kept manifold. The living tetrahedra around a node are seen as triangles on a small
// sphere about it, the node's link: a face that holds the node is an edge there, an edge that holds it a
// vertex. The mesh is manifold at the node if the link is one disc, or the whole sphere.
#include <algorithm>

#include "common/mesh/cut_mesh.hpp"

namespace palpate {

/// Removes something around the node if the mesh is not manifold there; false if it is.
bool CutMesh::repair(int node) {
  if (!is_joint_node_.empty() && is_joint_node_[node] && drop_unjoined(node)) return true;
  if (is_manifold_at(node)) return false;
  if (keep_largest_group(node, -1) || part_fans(node) || open_between_rims(node)) return true;
  for (int t : star_) kill(t);  // a link that does not lie on a sphere
  return true;
}

/// A link of one piece is a disc if its Euler characteristic is 1 and it has a rim, the sphere if it is 2
/// without one: a pinch, a second rim or a handle would lower it.
bool CutMesh::is_manifold_at(int node) {
  if (!has_node(node)) return true;
  if (gather(node, -1) > 1) return false;
  int corners = 0, rim_edges = 0;
  for (int t : star_)
    for (int f = 0; f < 4; ++f) {
      const int n = tetrahedra_[t][f];
      if (n == node) continue;
      corners += count_[n]++ == 0;
      rim_edges += outside(4 * t + f);
    }
  for (int t : star_)
    for (int n : tetrahedra_[t]) count_[n] = 0;
  const int triangles = static_cast<int>(star_.size()), edges = (3 * triangles + rim_edges) / 2;
  return corners - edges + triangles == (rim_edges > 0 ? 1 : 2);
}

/// Fills star_ with the living tetrahedra that hold `node`, and `other` unless that is negative, and sorts
/// them into groups that hang together through faces which hold these too. Returns the number of groups.
int CutMesh::gather(int node, int other) {
  star_.clear();
  for (int t : around_node(node)) {
    const auto& tet = tetrahedra_[t];
    if (!alive_[t] || (other >= 0 && std::find(tet.begin(), tet.end(), other) == tet.end())) continue;
    star_.push_back(t);
    group_[t] = -1;
  }
  group_size_.clear();
  for (int first : star_) {
    if (group_[first] >= 0) continue;
    const int group = static_cast<int>(group_size_.size());
    group_[first] = group;
    queue_.assign(1, first);
    for (std::size_t i = 0; i < queue_.size(); ++i)
      for (int f = 0; f < 4; ++f) {
        const int t = queue_[i], n = tetrahedra_[t][f], id = 4 * t + f;
        if (n == node || n == other || outside(id) || group_[across_[id] / 4] >= 0) continue;
        group_[across_[id] / 4] = group;
        queue_.push_back(across_[id] / 4);
      }
    group_size_.push_back(static_cast<int>(queue_.size()));
  }
  return static_cast<int>(group_size_.size());
}

/// Of several groups around a node or an edge only the largest stays; of equal ones that of the lowest
/// tetrahedron.
bool CutMesh::keep_largest_group(int node, int other) {
  if (gather(node, other) < 2) return false;
  const auto largest = std::max_element(group_size_.begin(), group_size_.end()) - group_size_.begin();
  for (int t : star_)
    if (group_[t] != largest) kill(t);
  return true;
}

/// A vertex of the link through which its rim passes more than once: an edge with several fans around it.
bool CutMesh::part_fans(int node) {
  gather(node, -1);
  const auto each_end_on_rim = [&](auto&& visit) {
    for (int t : star_)
      for (int f = 0; f < 4; ++f) {
        if (tetrahedra_[t][f] == node || !outside(4 * t + f)) continue;
        for (int n : facet(4 * t + f))
          if (n != node) visit(n);
      }
  };
  int pinched = -1;
  each_end_on_rim([&](int n) {
    if (++count_[n] > 2 && pinched < 0) pinched = n;
  });
  each_end_on_rim([&](int n) { count_[n] = 0; });
  return pinched >= 0 && keep_largest_group(node, pinched);
}

/// A link with several rims, of one piece and without pinches: what lies on a shortest way from rim to rim
/// goes, and the rims become one.
bool CutMesh::open_between_rims(int node) {
  gather(node, -1);
  for (int t : star_)
    for (int n : tetrahedra_[t]) rim_[n] = n;
  const auto end_on_rim = [&](int id) {
    const auto nodes = facet(id);
    return nodes[0] != node ? nodes[0] : nodes[1];
  };
  for (int t : star_)
    for (int id = 4 * t; id < 4 * t + 4; ++id) {
      if (tetrahedra_[t][id % 4] == node || !outside(id)) continue;
      const int first = rim(end_on_rim(id));
      for (int n : facet(id))
        if (n != node) rim_[rim(n)] = first;
    }

  // From all rims at once: group_ is the rim that a tetrahedron is reached from first.
  queue_.clear();
  for (int t : star_) {
    group_[t] = -1;
    for (int id = 4 * t; id < 4 * t + 4; ++id) {
      if (tetrahedra_[t][id % 4] == node || !outside(id)) continue;
      const int reached_from = rim(end_on_rim(id));
      if (group_[t] == reached_from) continue;
      if (group_[t] >= 0) return kill(t), true;
      group_[t] = reached_from;
      from_[t] = -1;
      depth_[t] = 1;
      queue_.push_back(t);
    }
  }
  int meeting = -1, shortest = 0;
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    const int t = queue_[i];
    for (int id = 4 * t; id < 4 * t + 4; ++id) {
      if (tetrahedra_[t][id % 4] == node || outside(id)) continue;
      const int next = across_[id] / 4;
      if (group_[next] < 0) {
        group_[next] = group_[t];
        from_[next] = t;
        depth_[next] = depth_[t] + 1;
        queue_.push_back(next);
      } else if (group_[next] != group_[t] && (meeting < 0 || depth_[t] + depth_[next] < shortest)) {
        meeting = id;
        shortest = depth_[t] + depth_[next];
      }
    }
  }
  if (meeting < 0) return false;
  for (int t : {meeting / 4, across_[meeting] / 4})
    for (; t >= 0; t = from_[t]) kill(t);
  return true;
}

/// The rim that a node of the link lies on, as the root of its tree in rim_.
int CutMesh::rim(int node) {
  while (rim_[node] != node) node = rim_[node] = rim_[rim_[node]];
  return node;
}

}  // namespace palpate
