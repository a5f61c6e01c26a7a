#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#include "common/bus/peers.hpp"

namespace palpate {

/// Which participant speaks for each run of a haptic loop or a deform node, on all topics: the first one, until it has
/// ended or has not been heard for a while. The number of a run is drawn by chance, so that nobody else is first.
class RunOwners {
 public:
  static constexpr std::int64_t kHeldNs = 2'500'000'000;  ///< each node says once a second how it is
  static constexpr std::size_t kRuns = 1024;              ///< beyond, a run is anybody's

  explicit RunOwners(const Peers& peers) : peers_(peers) {}

  /// `role`: bit of whose runs are numbered so; 0: a run that belongs to nobody. False if the run is another
  /// participant's. From any thread.
  bool admits(std::uint32_t role, std::uint64_t run, dds_instance_handle_t writer, std::int64_t now_ns);

 private:
  struct Owner {
    std::uint64_t participant = 0;
    std::int64_t heard_ns = 0;
  };

  const Peers& peers_;
  std::mutex mutex_;
  std::map<std::pair<std::uint32_t, std::uint64_t>, Owner> of_;
};

}  // namespace palpate
