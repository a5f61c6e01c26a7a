#include "tools/latency/hop_times.hpp"

#include <algorithm>

namespace palpate {

std::int64_t HopTimes::moved(std::int64_t time, const Clock& clock) {
  uncertainty_ = std::max(uncertainty_, clock.uncertainty);
  return time + clock.offset;
}

void HopTimes::add(const NodeStatus& m) {
  if (m.clock_of.empty()) return;
  const Clock clock{m.clock_offset_ns, m.clock_uncertainty_ns};
  clocks_[m.node] = clock;
  if (m.role == "deform") deform_ = clock;
}

void HopTimes::clear_times() {
  force_.clear();
  surface_.clear();
  picture_.clear();
  tissue_.begin_anew();
}

void HopTimes::add(const ForceState& m) {
  force_.record(m.publish_ns - m.sense_ns);
}

void HopTimes::add(const SurfaceState& m) {
  tissue_.add(m);
  const std::pair newest(m.run, m.step);
  const auto [known, first] = shown_.try_emplace(m.body, newest);
  if (m.run == 0 || (!first && known->second == newest)) return;
  known->second = newest;
  surface_.record(moved(m.publish_ns, deform_) - m.sense_ns);
}

void HopTimes::add(const PictureState& m) {
  if (m.run != 0) picture_.record(moved(m.publish_ns, clocks_[m.node]) - m.sense_ns);
}

}  // namespace palpate
