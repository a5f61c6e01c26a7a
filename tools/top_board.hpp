#pragma once
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/bus/bus.hpp"
#include "common/bus/sequence.hpp"
#include "tools/latency/hop_times.hpp"

namespace palpate {

/// A running system as `palpate top` sees it.
class TopBoard {
 public:
  explicit TopBoard(Bus& bus);

  void take();  ///< what has come
  /// What is known, and of the forces and times what has come since begin_anew(), `seconds` ago. Words of others are
  /// printable.
  std::string text(double seconds) const;
  nlohmann::ordered_json json(double seconds) const;
  void begin_anew();

 private:
  /// What has been heard of one node.
  struct Known {
    NodeStatus status;
    std::int64_t heard_ns = 0;
  };
  /// What has been heard of one tool since the last look.
  struct Hand {
    ForceState last;
    double strongest = 0;  ///< [N]
    std::uint64_t steps = 0;
  };

  std::string nodes_text() const;
  std::string hands_text(double seconds) const;
  std::string hops_text() const;

  std::unique_ptr<Reader<NodeStatus>> nodes_;
  std::unique_ptr<Reader<ForceState>> forces_;
  std::unique_ptr<Reader<SurfaceState>> surfaces_;
  std::unique_ptr<Reader<PictureState>> pictures_;
  std::map<std::string, Known> known_;
  std::map<std::uint32_t, Hand> hands_;
  SequenceCheck sequence_;
  HopTimes hops_;
  std::int64_t last_force_ns_ = 0;
};

}  // namespace palpate
