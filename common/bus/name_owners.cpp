#include "common/bus/name_owners.hpp"

namespace palpate {

bool NameOwners::admits(const std::string& name, std::uint64_t writer, std::int64_t now_ns, const Peers& peers) {
  const auto silent = [&](const Owner& owner) { return now_ns - owner.heard_ns >= kHeldNs; };
  const auto found = of_.find(name);
  if (found != of_.end()) {
    Owner& owner = found->second;
    if (owner.writer != writer && !silent(owner) && peers.of(owner.writer) != 0) return false;
    owner = {writer, now_ns};
    return true;
  }
  if (of_.size() >= kNames) std::erase_if(of_, [&](const auto& entry) { return silent(entry.second); });
  if (of_.size() < kNames) of_.emplace(name, Owner{writer, now_ns});
  return true;
}

}  // namespace palpate
