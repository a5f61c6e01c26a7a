#include "common/dynamics/numbering.hpp"

#include <algorithm>

namespace palpate {
namespace {

class CuthillMcKee {
 public:
  CuthillMcKee(std::span<const std::array<int, 2>> edges, int nodes)
      : edges_(edges), around_(incidence(edges, nodes)), level_(nodes, -1) {}

  std::vector<int> order() {
    const int nodes = static_cast<int>(level_.size());
    std::vector<int> by_degree(nodes), order;
    for (int n = 0; n < nodes; ++n) by_degree[n] = n;
    std::stable_sort(by_degree.begin(), by_degree.end(), [&](int a, int b) { return degree(a) < degree(b); });
    for (int n : by_degree)
      if (level_[n] < 0 && degree(n) > 0) append(order, breadth_first(far_end(n)));
    std::reverse(order.begin(), order.end());
    for (int n : by_degree)
      if (degree(n) == 0) order.push_back(n);
    return order;
  }

 private:
  int degree(int n) const { return around_.begin[n + 1] - around_.begin[n]; }

  static void append(std::vector<int>& order, const std::vector<int>& part) {
    order.insert(order.end(), part.begin(), part.end());
  }

  /// Nodes of the part of `start`, level by level, within a level by degree.
  std::vector<int> breadth_first(int start) {
    std::vector<int> queue{start}, next;
    level_[start] = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const int n = queue[i];
      next.clear();
      for (int e : around_.of(n)) {
        const int other = edges_[e][0] == n ? edges_[e][1] : edges_[e][0];
        if (level_[other] >= 0) continue;
        level_[other] = level_[n] + 1;
        next.push_back(other);
      }
      std::stable_sort(next.begin(), next.end(), [&](int a, int b) { return degree(a) < degree(b); });
      append(queue, next);
    }
    return queue;
  }

  /// A node at one end of the part: the deepest level grows until it no longer does.
  int far_end(int start) {
    for (int depth = -1;;) {
      const std::vector<int> part = breadth_first(start);
      const int last = part.back(), deepest = level_[last];
      for (int n : part) level_[n] = -1;
      if (deepest <= depth) return start;
      depth = deepest;
      start = last;
    }
  }

  std::span<const std::array<int, 2>> edges_;
  Incidence around_;
  std::vector<int> level_;
};

}  // namespace

std::vector<int> number_for_locality(std::span<const std::array<int, 2>> edges, int nodes) {
  const std::vector<int> order = CuthillMcKee(edges, nodes).order();
  std::vector<int> number(nodes);
  for (int i = 0; i < nodes; ++i) number[order[i]] = i;
  return number;
}

}  // namespace palpate
