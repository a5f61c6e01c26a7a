#include "common/bus/key_budget.hpp"

#include <functional>

namespace palpate {

bool KeyBudget::admits(std::uint64_t writer, const std::string& key) {
  if (used_.size() >= kWriters && !used_.contains(writer)) used_.clear();
  std::set<std::size_t>& keys = used_[writer];
  const std::size_t hash = std::hash<std::string>{}(key);
  if (keys.contains(hash)) return true;
  if (keys.size() >= kKeys) return false;
  keys.insert(hash);
  return true;
}

}  // namespace palpate
