#include "common/view/backdrop.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace palpate {
namespace {

/// Which nodes hang together, by union and find.
class Parts {
 public:
  explicit Parts(std::size_t nodes) : parent_(nodes) { std::iota(parent_.begin(), parent_.end(), 0); }

  int of(int node) {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
  }
  void join(int a, int b) { parent_[of(a)] = of(b); }

 private:
  std::vector<int> parent_;
};

}  // namespace

Backdrop sort_backdrop(const TriangleMesh& mesh) {
  Parts parts(mesh.nodes.size());
  std::map<std::pair<int, int>, int> triangles_at;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      parts.join(a, b);
      ++triangles_at[std::minmax(a, b)];
    }
  std::vector<bool> open(mesh.nodes.size(), false);
  for (const auto& [edge, count] : triangles_at)
    if (count == 1) open[parts.of(edge.first)] = true;

  Backdrop sorted{{mesh.nodes, {}}, {mesh.nodes, {}}};
  for (const auto& t : mesh.triangles) (open[parts.of(t[0])] ? sorted.lining : sorted.bones).triangles.push_back(t);
  return sorted;
}

}  // namespace palpate
