#pragma once
#include <map>
#include <string>
#include <utility>

#include "common/realtime/histogram.hpp"
#include "idl/messages.hpp"
#include "tools/latency/tissue_course.hpp"

namespace palpate {

/// One-way times from the sensing of a haptic step to what becomes of it, each message's own time moved to the haptic
/// node's clock by the offset that its writer announced. From a running system or from a log.
class HopTimes {
 public:
  void add(const ForceState& m);
  void add(const SurfaceState& m);
  void add(const PictureState& m);
  void add(const NodeStatus& m);
  void add(const DeformStep& m) { tissue_.add(m); }
  template <class M>
  void add(const M&) {}  ///< other messages tell nothing of it

  void clear_times();  ///< begins to measure anew, with the offsets that are known

  const Histogram& force() const { return force_; }      ///< [ns] the force handed to the bus
  const Histogram& surface() const { return surface_; }  ///< [ns] the first surface with that step handed to the bus
  const Histogram& picture() const { return picture_; }  ///< [ns] the first picture with that step done
  /// [ns] the widest that an offset in use may be off; 0 where all nodes have one clock.
  std::int64_t uncertainty_ns() const { return uncertainty_; }
  /// Messages that say they were written before the step was sensed, by more than that: they count as 0.
  std::uint64_t ahead() const { return ahead_; }
  const TissueCourse& tissue() const { return tissue_; }

 private:
  struct Clock {
    std::int64_t offset = 0, uncertainty = 0;
  };
  void record(Histogram& histogram, std::int64_t sense_ns, std::int64_t publish_ns, const Clock& clock);

  std::map<std::string, Clock> clocks_;  ///< by node
  Clock deform_;                         ///< of the deform node: surfaces do not say who wrote them
  std::map<std::uint32_t, std::pair<std::uint64_t, std::uint64_t>> shown_;  ///< by body: run and step
  Histogram force_, surface_, picture_;
  std::int64_t uncertainty_ = 0;
  std::uint64_t ahead_ = 0;
  TissueCourse tissue_;
};

/// A line that tells of those that are ahead; empty: none are.
std::string ahead_text(const HopTimes& hops);

}  // namespace palpate
