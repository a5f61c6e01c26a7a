#include "common/bus/key_budget.hpp"

#include <functional>

namespace palpate {

bool KeyBudget::admits(std::uint64_t peer, const std::string& key) {
  if (used_.size() >= kPeers && !used_.contains(peer)) used_.clear();
  std::set<std::size_t>& keys = used_[peer];
  const std::size_t hash = std::hash<std::string>{}(key);
  if (keys.contains(hash)) return true;
  if (keys.size() >= keys_) return false;
  keys.insert(hash);
  return true;
}

}  // namespace palpate
