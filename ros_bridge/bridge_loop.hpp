#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "common/bus/clock_link.hpp"
#include "common/bus/link_watch.hpp"
#include "common/bus/presence.hpp"
#include "common/node/surface_source.hpp"
#include "common/node/topology_feed.hpp"
#include "common/realtime/histogram.hpp"
#include "common/scene/scene.hpp"
#include "ros_bridge/body_topic.hpp"
#include "ros_bridge/tool_topics.hpp"

namespace palpate::ros {

/// What a run of the loop measured.
struct BridgeReport {
  double seconds = 0;
  std::uint64_t ticks = 0, missed = 0;
  std::uint64_t samples = 0;  ///< states of tools told to ROS
  std::uint64_t refused = 0;  ///< messages of foreign runs, or that do not fit the scene
  Histogram latency;          ///< [ns] from reading the tool to its pose being told
};

/// Takes what the bus has and tells ROS the newest of it: tools at a rate of its own, surfaces at the scene's visual
/// rate.
class BridgeLoop {
 public:
  /// `surfaces`: of each body at rest. `origin` [m]: where the source counts from.
  BridgeLoop(const Scene& scene, std::vector<SurfaceMap> surfaces, const Eigen::Vector3d& origin, Node& node,
             SurfaceSource& source, Bus& bus, Presence& presence);

  void set_topology(TopologyFeed* topology) { topology_ = topology; }
  /// `rate_hz`: of the tools. Until `seconds` are over (0: no limit) or a stop is requested.
  const BridgeReport& run(double rate_hz, double seconds);

 private:
  /// The newest message of each tool that has come since the last tick.
  template <class M>
  void take(Reader<M>& reader, std::vector<std::optional<M>>& newest);
  void tell_tools();
  void tell_surfaces(std::int64_t now);
  void keep_house(std::int64_t now);
  std::int64_t wall_time(std::int64_t theirs_ns) const;

  const Scene& scene_;
  SurfaceSource& source_;
  Bus& bus_;
  Presence& presence_;
  ClockFollower clock_;
  LinkWatch link_;
  TopologyFeed* topology_ = nullptr;
  std::unique_ptr<Reader<ToolState>> states_;
  std::unique_ptr<Reader<ForceState>> forces_;
  std::vector<std::optional<ToolState>> newest_states_;
  std::vector<std::optional<ForceState>> newest_forces_;
  std::vector<ToolTopics> tools_;
  std::vector<BodyTopic> bodies_;
  std::vector<std::vector<std::array<int, 3>>> triangles_;
  Eigen::Vector3d origin_;
  std::int64_t next_surface_ns_ = 0, last_status_ns_ = 0;
  std::uint64_t last_ticks_ = 0;
  Histogram recent_latency_;
  BridgeReport report_;
};

}  // namespace palpate::ros
