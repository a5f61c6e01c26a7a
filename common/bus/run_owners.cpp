#include "common/bus/run_owners.hpp"

namespace palpate {

bool RunOwners::admits(std::uint32_t role, std::uint64_t run, dds_instance_handle_t writer, std::int64_t now_ns) {
  if (role == 0 || run == 0) return true;
  const std::uint64_t participant = peers_.of(writer);
  const auto silent = [&](const Owner& owner) { return now_ns - owner.heard_ns >= kHeldNs; };
  const std::lock_guard lock(mutex_);
  if (const auto found = of_.find({role, run}); found != of_.end()) {
    Owner& owner = found->second;
    if (owner.participant != participant && !silent(owner) && peers_.has(owner.participant)) return false;
    owner = {participant, now_ns};
    return true;
  }
  if (of_.size() >= kRuns) std::erase_if(of_, [&](const auto& entry) { return silent(entry.second); });
  if (of_.size() < kRuns) of_.emplace(std::pair{role, run}, Owner{participant, now_ns});
  return true;
}

}  // namespace palpate
