#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#include "common/bus/peers.hpp"

namespace palpate {

/// Which participant speaks under each key: the first one that did, until it has ended or has not been heard for a
/// while. From any thread.
template <class Key>
class Owners {
 public:
  static constexpr std::int64_t kHeldNs = 2'500'000'000;  ///< each node says once a second how it is
  static constexpr std::size_t kKeys = 1024;              ///< beyond, a key is anybody's

  /// `peers`: which participants have not ended.
  explicit Owners(const Peers& peers) : peers_(peers) {}

  /// Whether a key is another participant's.
  bool another(const Key& key, std::uint64_t participant, std::int64_t now_ns) const {
    const std::lock_guard lock(mutex_);
    return has_another(key, participant, now_ns);
  }
  /// What a participant says under a key is to be admitted, unless the key has become another's by now: then false, and
  /// nothing has changed. One that is not known (0) comes to own nothing.
  bool admit(const Key& key, std::uint64_t participant, std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    if (has_another(key, participant, now_ns)) return false;
    if (participant == 0) return true;
    if (of_.size() >= kKeys && !of_.contains(key))
      std::erase_if(of_, [&](const auto& entry) { return silent(entry.second, now_ns); });
    if (of_.size() < kKeys || of_.contains(key)) of_[key] = {participant, now_ns};
    return true;
  }

 private:
  struct Owner {
    std::uint64_t participant = 0;
    std::int64_t heard_ns = 0;
  };
  bool has_another(const Key& key, std::uint64_t participant, std::int64_t now_ns) const {
    const auto found = of_.find(key);
    return found != of_.end() && found->second.participant != participant && !silent(found->second, now_ns) &&
           peers_.has(found->second.participant);
  }
  static bool silent(const Owner& owner, std::int64_t now_ns) { return now_ns - owner.heard_ns >= kHeldNs; }

  const Peers& peers_;
  mutable std::mutex mutex_;
  std::map<Key, Owner> of_;
};

/// A run of a haptic loop or a deform node: the bit of the role whose runs are numbered so, and its number, which is
/// drawn by chance, so that nobody else is first. On all topics alike.
using RunKey = std::pair<std::uint32_t, std::uint64_t>;

}  // namespace palpate
