#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace palpate {

/// How many names each peer may use as keys of a topic: a reader keeps something of each while their writer lives.
class KeyBudget {
 public:
  static constexpr std::size_t kKeys = 256;    ///< of a peer: a log that is played has all nodes of its runs
  static constexpr std::size_t kPeers = 1024;  ///< remembered; beyond, all begin anew

  explicit KeyBudget(std::size_t keys = kKeys) : keys_(keys) {}

  /// `peer`: a handle that is its own. False for a new name of a peer that has used its share.
  bool admits(std::uint64_t peer, const std::string& key);

 private:
  std::size_t keys_;
  std::map<std::uint64_t, std::set<std::size_t>> used_;  ///< hashes of keys by peer
};

}  // namespace palpate
