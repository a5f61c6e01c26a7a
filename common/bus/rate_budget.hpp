#pragma once
#include <cstdint>
#include <unordered_map>

namespace palpate {

/// How many samples of a topic each peer may send in a second, so that a flood costs a node no more than that.
class RateBudget {
 public:
  static constexpr int kPerSecond = 50'000;  ///< two tools at the fastest haptic rate

  /// `peer`: a handle that is its own. False for what is beyond its share of the second.
  bool admits(std::uint64_t peer, std::int64_t now_ns) {
    if (now_ns - begin_ns_ >= kSecondNs) {
      used_.clear();
      begin_ns_ = now_ns;
    }
    return ++used_[peer] <= kPerSecond;
  }

 private:
  static constexpr std::int64_t kSecondNs = 1'000'000'000;

  std::int64_t begin_ns_ = 0;
  std::unordered_map<std::uint64_t, int> used_;  ///< samples by peer
};

}  // namespace palpate
