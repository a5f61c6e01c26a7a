#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "common/bus/peers.hpp"

namespace palpate {

/// Which writer speaks in the name of each node: the first one, until it has ended or has not been heard for a while.
class NameOwners {
 public:
  static constexpr std::int64_t kHeldNs = 2'500'000'000;  ///< each node says once a second how it is
  static constexpr std::size_t kNames = 1024;             ///< beyond, a name is anybody's

  /// `peers`: which writers have not ended. False if the name is another writer's.
  bool admits(const std::string& name, std::uint64_t writer, std::int64_t now_ns, const Peers& peers);

 private:
  struct Owner {
    std::uint64_t writer = 0;
    std::int64_t heard_ns = 0;
  };
  std::map<std::string, Owner> of_;
};

}  // namespace palpate
