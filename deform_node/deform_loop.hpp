#pragma once
#include <cstdint>

#include "common/bus/bus.hpp"
#include "common/bus/clock_link.hpp"
#include "common/bus/link_watch.hpp"
#include "common/bus/presence.hpp"
#include "common/node/contact_feed.hpp"
#include "common/realtime/histogram.hpp"
#include "common/sim/range_monitor.hpp"
#include "deform_node/surface_publisher.hpp"

namespace palpate {

/// What a run of the loop measured.
struct DeformReport {
  double seconds = 0;
  std::uint64_t frames = 0;
  std::uint64_t refused = 0;  ///< messages of other scenes
  Histogram latency;          ///< [ns] sense time of the step to the surface being published
  Histogram deform;           ///< [ns] rebuilding the fields, correction and normals
};

/// Takes contacts and reduced states, rebuilds the shapes and publishes: what has changed at once when a message comes,
/// and everything at least at the visual rate.
class DeformLoop {
 public:
  DeformLoop(const Scene& scene, Deformer& deformer, Bus& bus, Presence& presence);

  const RangeMonitor& range() const { return range_; }

  /// Until `seconds` are over (0: no limit) or a stop is requested.
  const DeformReport& run(double seconds);

 private:
  void publish(bool all);
  void keep_house(std::int64_t now);
  void record_latency(std::int64_t ns);

  Deformer& deformer_;
  Bus& bus_;
  Presence& presence_;
  ClockFollower clock_;
  LinkWatch link_;
  std::int64_t frame_ns_;
  ContactFeed feed_;
  SurfacePublisher surfaces_;
  RangeMonitor range_;
  Histogram recent_latency_;  ///< since the last status
  std::int64_t last_status_ns_ = 0;
  std::uint64_t last_frames_ = 0;
  DeformReport report_;
};

}  // namespace palpate
