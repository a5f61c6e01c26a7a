#pragma once
#include <concepts>
#include <cstdint>
#include <map>
#include <vector>

#include "idl/messages.hpp"

namespace palpate {

/// Which messages a log goes without: what follows from the others is kept at the rate of pictures, or not at all.
/// Every input of a step stays, so that steps and ticks can be computed again.
struct Thinning {
  static constexpr std::uint64_t kKeyframes = 10;  ///< of so many one is kept, from the first of a run on

  std::uint64_t steps = 0;    ///< from one picture to the next; 0: everything is kept
  std::vector<bool> redrawn;  ///< bodies whose surface follows from what the haptic node says of them

  template <class M>
  bool keeps(const M& message) {
    if (steps == 0) return true;
    if constexpr (std::same_as<M, SurfaceState>)
      return message.body >= redrawn.size() || !redrawn[message.body];
    else if constexpr (std::same_as<M, HapticKeyframe> || std::same_as<M, DeformKeyframe>)
      return is_due(message.run, message.seq);
    else if constexpr (kOutcome<M>)
      return message.step % steps == 0;
    else
      return true;
  }
  /// Whether it may keep less than all of these.
  template <class M>
  static constexpr bool concerns() {
    return kOutcome<M> || std::same_as<M, SurfaceState> || std::same_as<M, HapticKeyframe> ||
           std::same_as<M, DeformKeyframe>;
  }

 private:
  static constexpr std::size_t kRuns = 1024;  ///< whose keyframes are thinned: a system never has more
  bool is_due(std::uint64_t run, std::uint64_t seq) {
    if (first_keyframe_.size() >= kRuns && !first_keyframe_.contains(run)) return true;
    return (seq - first_keyframe_.try_emplace(run, seq).first->second) % kKeyframes == 0;
  }
  std::map<std::uint64_t, std::uint64_t> first_keyframe_;  ///< its number, by run

  template <class M>
  static constexpr bool kOutcome =
      std::same_as<M, ForceState> || std::same_as<M, ContactState> || std::same_as<M, ModalState> ||
      std::same_as<M, CatheterState> || std::same_as<M, CreepState>;
};

}  // namespace palpate
