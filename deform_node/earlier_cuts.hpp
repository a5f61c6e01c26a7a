#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/presence.hpp"

namespace palpate {

/// What other nodes know the bodies to have lost when the deformation node starts. Tissue does not heal, so that of
/// several who know the one is right who knows of most.
class EarlierCuts {
 public:
  static constexpr std::int64_t kPatienceNs = 2'000'000'000;
  static constexpr std::int64_t kMeetingNs = 500'000'000;  ///< in which nodes hear of each other

  /// `bodies`: those that can be cut. `tetrahedra`: of all of them. `joined_ns`: when this node came into the network.
  EarlierCuts(Bus& bus, std::vector<int> bodies, std::size_t tetrahedra, std::int64_t joined_ns)
      : reader_(bus.reader(topics::held_topology, Keep::all, 2 * sizeof(std::uint32_t) * tetrahedra)),
        bodies_(std::move(bodies)),
        joined_ns_(joined_ns) {}

  /// True once this node has had the time to meet the others and every known haptic and render node of the same scene
  /// has told of all bodies, or the patience is over. Call again until then.
  bool complete(const Presence& presence, std::int64_t now_ns);

  bool in_time() const { return in_time_; }           ///< nobody kept it waiting for too long
  const HeldTopology* of(int body) const;             ///< nullptr if nobody knows of any
  bool another_had_them() const { return another_; }  ///< the bodies were another deformation node's before

 private:
  bool told_by_all(const Presence& presence) const;

  std::unique_ptr<Reader<HeldTopology>> reader_;
  std::vector<int> bodies_;
  std::int64_t joined_ns_;
  std::set<std::pair<std::string, int>> told_;  ///< node and body
  std::map<int, HeldTopology> most_;
  std::optional<std::int64_t> asked_ns_;
  bool in_time_ = true, another_ = false;
};

}  // namespace palpate
