#pragma once
#include <dds/dds.h>

#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>

#include "common/bus/dds_convert.hpp"
#include "common/bus/key.hpp"
#include "common/bus/key_budget.hpp"
#include "common/bus/owners.hpp"
#include "common/bus/peers.hpp"
#include "common/bus/rate_budget.hpp"
#include "common/bus/roles.hpp"
#include "common/bus/waiting_room.hpp"
#include "common/realtime/clock.hpp"
#include "idl/limits.hpp"

namespace palpate::dds {

/// [bytes] of a message's sequences and strings.
struct CountBytes {
  std::size_t bytes = 0;
  template <class T>
  void operator()(const char*, const T& field) {
    if constexpr (requires { field.size(); }) bytes += field.size() * sizeof(*field.data());
  }
};

/// What stands between the middleware and a reader's memory. Every sample from outside passes here, on the
/// middleware's threads, before anything of it is kept: only a valid one, under a name and at a rate within its
/// peer's budget, a node's under its own name, in a run of its own, and within the reader's room. One that is refused
/// costs no other sample its place.
template <class M>
class Gate {
 public:
  static constexpr std::size_t kNodes = 64;  ///< names of nodes that a peer may use where the newest is kept

  /// `peers`, `runs`: of the bus. `total`: counts what is refused by all its gates. `run_of`: whose run the messages
  /// carry, of the topic. `keeps_all`: what is admitted waits until it is taken, `room` [bytes] of each peer at most.
  Gate(const Peers& peers, Owners<RunKey>& runs, std::atomic<std::uint64_t>& total, std::uint32_t run_of,
       bool keeps_all, std::size_t room)
      : peers_(peers),
        runs_(runs),
        names_(peers),
        total_(total),
        run_of_(run_of),
        keeps_all_(keeps_all),
        budget_(kOfNodes && !keeps_all ? kNodes : KeyBudget::kKeys),
        room_(room) {}

  /// For dds_set_topic_filter_extended(). The middleware calls it for one sample of a reader at a time.
  static bool filter(const void* sample, const dds_sample_info_t* info, void* self) {
    return static_cast<Gate*>(self)->admits(*static_cast<const typename Generated<M>::Type*>(sample),
                                            info->publication_handle);
  }
  /// One more has been refused, here or before it came here.
  void refuse() {
    refused_.fetch_add(1, std::memory_order_relaxed);
    total_.fetch_add(1, std::memory_order_relaxed);
  }
  /// An admitted sample has been taken.
  void taken(const M& message, dds_instance_handle_t writer) {
    if (keeps_all_) room_.leave(writer, size(message));
  }
  std::uint64_t refused() const { return refused_.load(std::memory_order_relaxed); }

 private:
  static constexpr bool kOfNodes = std::same_as<M, NodeStatus>;

  bool admits(const typename Generated<M>::Type& sample, dds_instance_handle_t writer) {
    fields(CopyOut{}, message_, sample);
    const std::uint64_t peer = peer_of(writer);
    if (in_time(peer) && valid(message_) && in_budget(peer) && !anothers_name() && !anothers_run() &&
        has_room(writer, peer)) {
      if (becomes_owner()) return true;
      taken(message_, writer);
    }
    refuse();
    return false;
  }
  /// All writers of a participant have one budget. A writer that is not known yet has its own.
  std::uint64_t peer_of(dds_instance_handle_t writer) {
    if (writer != writer_ || participant_ == 0) participant_ = peers_.of(writer_ = writer);
    return participant_ != 0 ? participant_ : writer;
  }
  /// One that keeps all has its room alone: a recorder wants a log that is played faster than it was made.
  bool in_time(std::uint64_t peer) { return keeps_all_ || rate_.admits(peer, now_ns()); }
  bool in_budget(std::uint64_t peer) {
    if constexpr (requires { message_.node; }) return budget_.admits(peer, key_of(message_));
    return true;  // numbers have their limits in the IDL
  }
  /// One that keeps all keeps what each says.
  bool anothers_name() const {
    if constexpr (kOfNodes) return !keeps_all_ && names_.another(message_.node, participant_, now_ns());
    return false;
  }
  bool anothers_run() const {
    if constexpr (requires { message_.run; }) return of_somebody() && runs_.another(run(), participant_, now_ns());
    return false;
  }
  /// Only what is admitted makes an owner. False if another has become it since it was looked at.
  bool becomes_owner() {
    if constexpr (kOfNodes)
      if (!keeps_all_ && !names_.admit(message_.node, participant_, now_ns())) return false;
    if constexpr (requires { message_.run; })
      if (of_somebody() && !runs_.admit(run(), participant_, now_ns())) return false;
    return true;
  }
  RunKey run() const {
    if constexpr (kOfNodes)
      return {role_bit(message_.role), message_.run};
    else
      return {run_of_, message_.run};
  }
  bool of_somebody() const { return run().first != 0 && run().second != 0; }
  bool has_room(dds_instance_handle_t writer, std::uint64_t peer) {
    return !keeps_all_ || room_.enter(writer, peer, size(message_));
  }
  static std::size_t size(const M& message) {
    CountBytes count;
    fields(count, message);
    return count.bytes;
  }

  const Peers& peers_;
  Owners<RunKey>& runs_;
  Owners<std::string> names_;
  std::atomic<std::uint64_t>& total_;
  const std::uint32_t run_of_;
  const bool keeps_all_;
  M message_;                         ///< kept between samples for its memory
  dds_instance_handle_t writer_ = 0;  ///< of the sample before
  std::uint64_t participant_ = 0;     ///< of that; 0: not known
  KeyBudget budget_;
  RateBudget rate_;
  WaitingRoom room_;
  std::atomic<std::uint64_t> refused_ = 0;
};

}  // namespace palpate::dds
