#include "ros_bridge/bridge_loop.hpp"

#include "common/log/log.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/view/looks.hpp"

namespace palpate::ros {

BridgeLoop::BridgeLoop(const Scene& scene, std::vector<SurfaceMap> surfaces, const Eigen::Vector3d& origin, Node& node,
                       SurfaceSource& source, Bus& bus, Presence& presence)
    : scene_(scene),
      source_(source),
      bus_(bus),
      presence_(presence),
      clock_(bus, presence.node()),
      link_(bus),
      states_(bus.reader(topics::tool_state)),
      forces_(bus.reader(topics::force_state)),
      origin_(origin) {
  presence_.set_clock(&clock_);
  for (const Tool& tool : scene.tools) tools_.emplace_back(node, tool);
  const Render render = scene.render.value_or(Render{});
  for (std::size_t b = 0; b < surfaces.size(); ++b) {
    const Body& body = scene.bodies[b];
    bodies_.emplace_back(node, name_of(body), look_of(body, surfaces[b], render).colour);
    triangles_.push_back(std::move(surfaces[b].triangles));
  }
}

// A time on the haptic node's clock.
std::int64_t BridgeLoop::wall_time(std::int64_t theirs_ns) const {
  return clock_.to_own(theirs_ns) + wall_ns() - now_ns();
}

template <class M>
void BridgeLoop::take(Reader<M>& reader, std::vector<std::optional<M>>& newest) {
  newest.assign(tools_.size(), {});
  while (auto message = reader.take()) {
    const bool good = message->tool < newest.size() && presence_.accepts(message->run);
    if (good) newest[message->tool] = std::move(message);
    report_.refused += !good;
  }
}

void BridgeLoop::tell_tools() {
  take(*states_, newest_states_);
  take(*forces_, newest_forces_);
  for (std::size_t t = 0; t < tools_.size(); ++t) {
    if (const auto& state = newest_states_[t]; state) {
      tools_[t].tell(*state, wall_time(state->sense_ns));
      ++report_.samples;
      const std::int64_t latency = now_ns() - clock_.to_own(state->sense_ns);
      report_.latency.record(latency);
      recent_latency_.record(latency);
    }
    if (const auto& force = newest_forces_[t]; force) tools_[t].tell(*force, wall_time(force->sense_ns));
  }
}

void BridgeLoop::tell_surfaces(std::int64_t now) {
  if (now < next_surface_ns_) return;
  next_surface_ns_ = now + static_cast<std::int64_t>(1e9 / scene_.rates.visual_hz);
  source_.update();
  if (topology_)
    for (const int body : topology_->take()) triangles_[body] = topology_->triangles(body);
  const SurfaceSource::Moment moment = source_.moment();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto position = source_.shape(static_cast<int>(b)).position;
    if (position.empty() || !bodies_[b].wanted()) continue;
    bodies_[b].tell(origin_, position, triangles_[b], moment.run != 0 ? wall_time(moment.sense_ns) : wall_ns());
  }
}

void BridgeLoop::keep_house(std::int64_t now) {
  for (const std::string& said : presence_.watch()) log_info(said);
  for (const std::string& said : link_.look(presence_, now)) log_warning(said);
  if (now - last_status_ns_ < kNsPerS) return;
  const double rate =
      1e9 * static_cast<double>(report_.ticks - last_ticks_) / static_cast<double>(now - last_status_ns_);
  const Percentiles latency = percentiles_us(recent_latency_);
  presence_.announce(rate, report_.ticks, report_.missed, latency.p50, latency.p99, link_.silence("haptic", now));
  recent_latency_.clear();
  last_status_ns_ = now;
  last_ticks_ = report_.ticks;
}

const BridgeReport& BridgeLoop::run(double rate_hz, double seconds) {
  PeriodicTimer timer(rate_hz, 0);
  const std::int64_t begin = now_ns();
  std::int64_t next_house = last_status_ns_ = begin;
  presence_.announce(0, 0, 0, 0, 0);
  while (!shutdown_requested()) {
    const std::int64_t now = now_ns();
    if (seconds > 0 && 1e-9 * static_cast<double>(now - begin) >= seconds) break;
    clock_.follow();
    if (now >= next_house) {
      keep_house(now);
      next_house = now + 50'000'000;
    }
    tell_tools();
    tell_surfaces(now);
    timer.wait();
    ++report_.ticks;
    report_.missed = timer.statistics().skipped;
  }
  report_.seconds = 1e-9 * static_cast<double>(now_ns() - begin);
  report_.refused += source_.refused() + bus_.refused();
  return report_;
}

}  // namespace palpate::ros
