#pragma once
#include <atomic>
#include <memory>
#include <semaphore>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/clock_link.hpp"
#include "common/bus/link_watch.hpp"
#include "common/bus/presence.hpp"
#include "common/node/pace_watch.hpp"
#include "common/node/topology_memory.hpp"
#include "common/realtime/histogram.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/spsc_ring.hpp"
#include "common/sim/haptic_step.hpp"
#include "common/tool/motion_guard.hpp"
#include "haptic_node/bus_devices.hpp"
#include "haptic_node/interventions.hpp"
#include "haptic_node/local_feed.hpp"
#include "haptic_node/publisher.hpp"

namespace palpate {

/// What a run of the loop measured.
struct LoopReport {
  double seconds = 0;
  std::uint64_t ticks = 0;
  std::uint64_t dropped = 0;  ///< step records that found the ring full
  Histogram step, push;       ///< [ns] whole tick; hand-over to the publisher
  Histogram wire;             ///< [ns] from there until the bus has all messages of a step
  PeriodStatistics period;
  double max_force = 0;                                                                     ///< [N]
  std::uint64_t limited = 0, regularised = 0, faults = 0, stale = 0, late = 0, damped = 0;  ///< steps
  std::uint64_t force_limited = 0, slew_limited = 0;                                        ///< steps, of those limited
  std::uint64_t silent = 0;              ///< steps without a driver's word
  std::uint64_t behind = 0;              ///< [s] in which steps were late
  double min_energy = 0;                 ///< [J] of all tools together
  std::uint64_t refused_samples = 0;     ///< of devices: no possible pose, or a jump that the next did not confirm
  std::uint64_t followed_samples = 0;    ///< steps in which a tool followed its device at a bounded speed
  std::uint64_t refused_models = 0;      ///< local contact models of steps to come
  std::uint64_t implausible_models = 0;  ///< local contact models that cannot be of this tissue
  std::uint64_t implausible = 0;         ///< steps in which one asked for more force than the tissue can give
  std::uint64_t refused_messages = 0;    ///< by the bus
};

/// Runs a HapticStep at its fixed rate on the calling thread, with a publisher thread that writes to the bus and
/// a pump for devices elsewhere and local contact models. The tick itself reads devices and models, steps, and pushes
/// into a ring: no more.
class HapticLoop {
 public:
  HapticLoop(HapticStep& haptic, std::vector<std::unique_ptr<Device>>& devices, Bus& bus, Presence& presence,
             std::uint64_t run, std::string code_path);
  ~HapticLoop();

  /// What has been cut, kept for a deformation node that returns.
  void set_topology(TopologyMemory* topology) { topology_ = topology; }

  /// Until `seconds` are over (0: no limit), every device has finished, or a stop is requested; then for as long as it
  /// takes to let the force fade, as for a driver that is silent.
  const LoopReport& run(double seconds);
  HandlingFigures handling(int tool) const { return publisher_.handling(tool); }  ///< once it has run

 private:
  void tick(double seconds);
  void count(std::uint32_t flags);
  void checkpoint();
  void publish_loop();
  void drain();
  void report_status(std::int64_t now);
  void check_peers();
  void say_interventions();
  std::uint64_t refused_samples() const;
  bool is_over(double time, double seconds) const;
  bool pushes() const;  ///< some hand is given a force

  HapticStep& haptic_;
  Bus& bus_;
  std::vector<std::unique_ptr<Device>>& devices_;
  Presence& presence_;
  Publisher publisher_;
  ClockServer clock_;
  LinkWatch link_;
  BusDevices bus_devices_;
  LocalFeed local_feed_;
  TopologyMemory* topology_ = nullptr;
  std::uint64_t step_ = 0, keyframe_interval_;
  bool leaves_ = false;  ///< the end has come, and the force fades
  std::vector<DeviceSample> samples_;
  std::vector<MotionGuard> guards_;  ///< per tool
  std::vector<ToolDofs> dofs_;
  SpscRing<StepRecord> ring_;
  HapticKeyframe keyframe_;
  std::atomic<bool> keyframe_full_{false};
  std::counting_semaphore<> wake_{0};
  std::atomic<bool> over_{false};
  std::atomic<bool> gives_way_{false};
  std::string lost_claim_;  ///< why; the publisher's until over_
  std::atomic<std::uint64_t> shown_ticks_{0}, shown_missed_{0}, shown_dropped_{0};
  std::atomic<std::uint32_t> shown_flags_{0};  ///< of all steps since they were told
  std::atomic<std::uint64_t> shown_refused_{0}, shown_followed_{0};
  Interventions told_;
  bool told_of_dropped_ = false;
  PaceWatch pace_{"the force", "its steps are late"};
  std::int64_t last_status_ns_ = 0;
  std::uint64_t last_status_ticks_ = 0;
  LoopReport report_;
};

}  // namespace palpate
