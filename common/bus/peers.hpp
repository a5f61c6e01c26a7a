#pragma once
#include <dds/dds.h>

#include <cstdint>
#include <mutex>
#include <unordered_map>

#include "common/bus/dds_entity.hpp"

namespace palpate {

/// Which participant each writer of the domain belongs to, from what the middleware discovers, so that a budget is a
/// participant's however many writers it makes.
class Peers {
 public:
  explicit Peers(dds_entity_t participant);
  Peers(const Peers&) = delete;
  Peers& operator=(const Peers&) = delete;

  /// A handle of the participant of a writer, by the handle that samples carry; 0 of one that is not known (any more).
  /// From any thread.
  std::uint64_t of(dds_instance_handle_t writer) const;
  /// Whether a participant has writers, by its handle. From any thread.
  bool has(std::uint64_t participant) const;

 private:
  static void changed(dds_entity_t reader, void* self);
  void note(const dds_builtintopic_endpoint_t& writer, const dds_sample_info_t& info);

  mutable std::mutex mutex_;
  std::unordered_map<dds_instance_handle_t, std::uint64_t> of_;
  std::unordered_map<std::uint64_t, int> writers_;  ///< of each participant
  Entity reader_;                                   // last: no more is told once it is gone
};

}  // namespace palpate
