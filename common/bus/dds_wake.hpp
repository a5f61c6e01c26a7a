#pragma once
#include <dds/dds.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>

#include "common/bus/dds_entity.hpp"

namespace palpate {

/// What follows when something comes to a reader of a bus: who waits is woken, or who serves is called on the
/// middleware's own thread, which has it from the network.
class DdsWake {
 public:
  explicit DdsWake(dds_entity_t participant);
  ~DdsWake() { dds_delete_listener(listener_); }

  /// For each reader as it is made.
  const dds_listener_t* listener() const { return listener_; }
  /// `condition`: of such a reader, true while there is something to take.
  void attach(dds_entity_t condition) { dds_waitset_attach(all_, condition, 0); }

  bool wait(std::chrono::nanoseconds timeout);  ///< as Bus::wait() has it
  void serve(std::function<bool()> news);       ///< as Bus::serve() has it

 private:
  void came();

  Entity all_;               ///< wait set of all readers
  Entity left_, only_left_;  ///< that a call has left something, and the wait set of that alone
  dds_listener_t* listener_;
  std::mutex calling_;
  std::function<bool()> news_;
  std::atomic<bool> serves_ = false;
  std::atomic<int> due_ = 0;  ///< calls, with the one under way
};

}  // namespace palpate
