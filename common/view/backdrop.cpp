#include "common/view/backdrop.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "common/geometry/joined_sets.hpp"

namespace palpate {

Backdrop sort_backdrop(const TriangleMesh& mesh) {
  JoinedSets parts(mesh.nodes.size());
  std::map<std::pair<int, int>, int> triangles_at;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      parts.join(a, b);
      ++triangles_at[std::minmax(a, b)];
    }
  std::vector<bool> lining(mesh.nodes.size(), false);
  for (const auto& [edge, count] : triangles_at)
    if (count == 1) lining[parts.leader(edge.first)] = true;
  std::vector<double> volume(mesh.nodes.size(), 0);
  for (const auto& [a, b, c] : mesh.triangles)
    volume[parts.leader(a)] += mesh.nodes[a].dot(mesh.nodes[b].cross(mesh.nodes[c]));
  for (std::size_t part = 0; part < volume.size(); ++part)
    if (volume[part] < 0) lining[part] = true;

  Backdrop sorted{{mesh.nodes, {}}, {mesh.nodes, {}}};
  for (const auto& t : mesh.triangles)
    (lining[parts.leader(t[0])] ? sorted.lining : sorted.bones).triangles.push_back(t);
  return sorted;
}

}  // namespace palpate
