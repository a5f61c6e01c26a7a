#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#include "common/bus/peers.hpp"

namespace palpate {

/// Which participant speaks under each key: the first one that did, until it has ended. One that has not been heard for
/// a while may only stand still: another may speak for it meanwhile, and it has its key back as soon as it is heard.
/// From any thread.
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
      std::erase_if(of_, [&](const auto& entry) {
        return !speaks(entry.second.first, now_ns) && !speaks(entry.second.deputy, now_ns);
      });
    if (of_.size() < kKeys || of_.contains(key)) note(of_[key], {participant, now_ns});
    return true;
  }

 private:
  struct Speaker {
    std::uint64_t participant = 0;
    std::int64_t heard_ns = 0;
  };
  struct Owner {
    Speaker first, deputy;
  };
  bool has_another(const Key& key, std::uint64_t participant, std::int64_t now_ns) const {
    const auto found = of_.find(key);
    if (found == of_.end()) return false;
    const auto& [first, deputy] = found->second;
    if (first.participant == participant && participant != 0) return false;
    return speaks(first, now_ns) || (deputy.participant != participant && speaks(deputy, now_ns));
  }
  void note(Owner& owner, const Speaker& speaker) const {
    const bool first = owner.first.participant == speaker.participant || !peers_.has(owner.first.participant);
    (first ? owner.first : owner.deputy) = speaker;
  }
  bool speaks(const Speaker& speaker, std::int64_t now_ns) const {
    return now_ns - speaker.heard_ns < kHeldNs && peers_.has(speaker.participant);
  }

  const Peers& peers_;
  mutable std::mutex mutex_;
  std::map<Key, Owner> of_;
};

/// A run of a haptic loop or a deform node: the bit of the role whose runs are numbered so, and its number, which is
/// drawn by chance, so that nobody else is first. On all topics alike.
using RunKey = std::pair<std::uint32_t, std::uint64_t>;

}  // namespace palpate
