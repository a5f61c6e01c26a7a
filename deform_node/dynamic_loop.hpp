#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/clock_link.hpp"
#include "common/bus/link_watch.hpp"
#include "common/bus/presence.hpp"
#include "common/dynamics/resection.hpp"
#include "common/node/contact_feed.hpp"
#include "common/node/pace_watch.hpp"
#include "common/realtime/histogram.hpp"
#include "common/realtime/periodic.hpp"
#include "common/sim/dynamic_world.hpp"
#include "common/sim/local_models.hpp"
#include "common/sim/range_monitor.hpp"
#include "common/sim/tissue_time.hpp"
#include "deform_node/earlier_cuts.hpp"
#include "deform_node/surface_publisher.hpp"

namespace palpate {

/// What a run of the loop measured.
struct DynamicReport {
  double seconds = 0;  ///< since the first tick
  std::uint64_t ticks = 0, frames = 0;
  std::uint64_t refused = 0;                    ///< tool states of other scenes
  std::uint64_t cut = 0, torn = 0, fallen = 0;  ///< tetrahedra
  Histogram tick;                               ///< [ns] advancing the tissue
  Histogram latency;                            ///< [ns] sense time of the tool's step to the surface being published
  std::uint64_t behind = 0;                     ///< [s] in which ticks were left out
  std::int64_t late_ns = 0;                     ///< by which the tissue's time was behind in the last tick
  PeriodStatistics period;
};

/// Advances moving tissue in real time: takes the tools' newest states, ticks the world, journals, sends local contact
/// models and cuts, and publishes all surfaces at the visual rate. A tick that comes late is left out: time in the
/// tissue then runs slower; every message says what that time is and how late, and the report says how often. The
/// tissue rests until a tool is first heard of, and others have told what it had lost before this node started; if it
/// comes back to tools that are in the tissue, that first comes to rest around them.
class DynamicLoop {
 public:
  /// `deformer`: of the scene's quasi-static bodies.
  DynamicLoop(DynamicWorld& world, LocalModels& local_models, Deformer& deformer, Bus& bus, Presence& presence,
              const Scene& scene, std::uint64_t run, std::string code_path);

  const RangeMonitor& range() const { return range_; }
  /// By body, where the scene marks what is to be cut off.
  const std::map<int, Resection>& resections() const { return resections_; }

  /// Begins with whole bodies, whatever others know of them.
  void forget_earlier_cuts() { whole_ = true; }

  /// Until `seconds` are over (0: no limit) or a stop is requested.
  const DynamicReport& run(double seconds);

 private:
  void take_tools();
  void take_earlier_cuts();
  void begin_tissue(std::int64_t now);
  void settle(std::int64_t now);
  void tell_begin();
  void tick(std::int64_t due_ns);
  void publish_change(int organ, RemovalCause cause, const std::vector<int>& removed);
  void publish_changes();
  void count(int organ);
  void publish_models();
  void publish_frames();
  void keep_house(std::int64_t now);

  Bus& bus_;
  DynamicWorld& world_;
  Deformer& deformer_;
  Presence& presence_;
  ClockFollower clock_;
  LinkWatch link_;
  std::uint64_t run_;
  double visual_hz_;
  std::vector<char> moves_;         ///< per body: it is dynamic
  std::vector<std::string> names_;  ///< per body
  LocalModels& local_models_;
  ContactFeed feed_;
  SurfacePublisher surfaces_;
  RangeMonitor range_;
  Histogram recent_latency_;  ///< since the last status
  PaceWatch pace_{"the tissue", "its time goes slower"};
  std::unique_ptr<Reader<ToolState>> tools_;
  std::unique_ptr<Writer<TopologyChange>> changes_;
  std::unique_ptr<Writer<LocalContactModel>> models_;
  std::unique_ptr<Writer<DeformStep>> steps_;
  std::unique_ptr<Writer<DeformKeyframe>> keyframes_;
  std::vector<std::uint64_t> change_seq_;  ///< per body
  std::map<int, Resection> resections_;
  std::vector<LocalContactModel> model_;  ///< per tool
  DeformStep step_;
  DeformKeyframe keyframe_;
  TissueTime time_;
  std::int64_t first_due_ns_ = 0;  ///< when the first tick was due
  std::vector<Eigen::Vector3f> position_, normal_;
  EarlierCuts earlier_;
  bool whole_ = false;  ///< they do not count
  enum class Phase { waiting, settling, moving };
  Phase phase_ = Phase::waiting;
  bool heard_ = false;            ///< a tool has been heard of
  std::uint64_t tools_from_ = 0;  ///< writer of the newest state
  bool late_ = false;             ///< the tools had been moving without this node
  std::int64_t shown_sense_ns_ = 0, last_status_ns_ = 0;
  std::uint64_t last_ticks_ = 0;
  DynamicReport report_;
};

}  // namespace palpate
