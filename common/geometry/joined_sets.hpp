#pragma once
#include <algorithm>
#include <numeric>
#include <vector>

namespace palpate {

/// Things that are joined to one another; of all that hang together the one with the least number is the leader.
class JoinedSets {
 public:
  explicit JoinedSets(std::size_t count) : leader_(count) { std::iota(leader_.begin(), leader_.end(), 0); }

  int leader(int i) {
    while (leader_[i] != i) i = leader_[i] = leader_[leader_[i]];
    return i;
  }
  void join(int a, int b) {
    const auto [low, high] = std::minmax({leader(a), leader(b)});
    leader_[high] = low;
  }

 private:
  std::vector<int> leader_;
};

}  // namespace palpate
