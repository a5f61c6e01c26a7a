#include "tools/latency/hop_times.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {

void HopTimes::record(Histogram& histogram, std::int64_t sense_ns, std::int64_t publish_ns, const Clock& clock) {
  uncertainty_ = std::max(uncertainty_, clock.uncertainty);
  const std::int64_t time = publish_ns + clock.offset - sense_ns;
  ahead_ += time < -clock.uncertainty;
  histogram.record(time);
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
  ahead_ = 0;
  tissue_.begin_anew();
}

void HopTimes::add(const ForceState& m) {
  record(force_, m.sense_ns, m.publish_ns, {});
}

void HopTimes::add(const SurfaceState& m) {
  tissue_.add(m);
  const std::pair newest(m.run, m.step);
  const auto [known, first] = shown_.try_emplace(m.body, newest);
  if (m.run == 0 || (!first && known->second == newest)) return;
  known->second = newest;
  record(surface_, m.sense_ns, m.publish_ns, deform_);
}

void HopTimes::add(const PictureState& m) {
  if (m.run != 0) record(picture_, m.sense_ns, m.publish_ns, clocks_[m.node]);
}

std::string ahead_text(const HopTimes& hops) {
  if (hops.ahead() == 0) return {};
  return fmt::format("{} of these say that they were written before their step was sensed, and count as 0\n",
                     hops.ahead());
}

}  // namespace palpate
