#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/clock_link.hpp"
#include "common/bus/link_watch.hpp"
#include "common/bus/presence.hpp"
#include "common/dynamics/resection.hpp"
#include "common/node/surface_source.hpp"
#include "common/node/topology_feed.hpp"
#include "common/realtime/histogram.hpp"
#include "common/view/draw_list.hpp"
#include "common/view/instrument.hpp"
#include "web_node/hands.hpp"
#include "web_node/scenery.hpp"
#include "web_node/server.hpp"

namespace palpate::web {

/// What a run of the loop measured.
struct WebReport {
  double seconds = 0;
  std::uint64_t frames = 0, missed = 0;
  std::uint64_t samples_refused = 0;  ///< messages of foreign runs, or that do not fit the scene
  Histogram latency;                  ///< [ns] from reading the tool to the frame that shows it
};

/// Takes what the bus has and gives the server frames, at the scene's visual rate; while a page leads a tool, up to
/// twice as often, each as soon as the tool has its sample.
class WebLoop {
 public:
  /// What each body is like at the beginning.
  struct Beginning {
    std::vector<std::array<int, 3>> triangles;
    std::vector<Eigen::Vector3f> rest;  ///< [m] from the origin on
    bool visual = false;                ///< a visual surface is drawn in place of the triangles
  };
  /// `origin` [m]: where places at the page, and those of the source, are counted from.
  WebLoop(const Scene& scene, const Eigen::Vector3d& origin, std::vector<Beginning> bodies, SurfaceSource& source,
          Bus& bus, Presence& presence, const Hands& hands, Server& server);

  /// `resections`: uncut, of the bodies whose scene marks what is to be cut off.
  void set_topology(TopologyFeed* topology, std::map<int, Resection> resections) {
    topology_ = topology;
    whole_ = resections_ = std::move(resections);
  }
  /// Until `seconds` are over (0: no limit) or a stop is requested.
  const WebReport& run(double seconds);

 private:
  struct Instrument {
    Trocar trocar;
    InstrumentView view;
    InstrumentShape shape;
    ToolState state;
    ForceState force;
    bool seen = false;
    std::int64_t heard_ns = 0;  ///< when its newest state came
  };
  void take();
  void take_tool(const ToolState& state);
  void follow_cuts();
  bool hand_moved() const;
  void send_frame();
  FrameTool tool_in_frame(int tool, std::int64_t now) const;
  void keep_house(std::int64_t now);
  void send_status(std::int64_t now);

  const Scene& scene_;
  SurfaceSource& source_;
  Bus& bus_;
  Presence& presence_;
  const Hands& hands_;
  Server& server_;
  ClockFollower clock_;
  LinkWatch link_;
  TopologyFeed* topology_ = nullptr;
  std::map<int, Resection> whole_, resections_;  ///< before any cut, and now
  std::unique_ptr<Reader<ToolState>> tools_;
  std::unique_ptr<Reader<ForceState>> forces_;
  std::unique_ptr<Reader<TaskRecord>> tasks_;  ///< null where no body tells a task
  std::vector<Instrument> instruments_;
  std::map<std::uint32_t, TaskRecord> latest_task_;
  std::vector<Beginning> bodies_;
  std::vector<BodyTopology> topologies_;
  std::uint32_t topology_number_ = 0;
  Frame frame_;
  std::vector<FrameTool> frame_tools_;
  std::int64_t begin_ns_ = 0, last_sense_ns_ = 0, last_status_ns_ = 0;
  std::uint64_t last_frames_ = 0;
  double rate_hz_ = 0;
  Histogram recent_latency_;
  WebReport report_;
};

}  // namespace palpate::web
