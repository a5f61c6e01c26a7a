#include "deform_node/deform_loop.hpp"

#include "common/log/log.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/shutdown.hpp"

namespace palpate {

DeformLoop::DeformLoop(const Scene& scene, Deformer& deformer, Bus& bus, Presence& presence)
    : deformer_(deformer),
      bus_(bus),
      presence_(presence),
      clock_(bus, presence.node()),
      link_(bus),
      frame_ns_(static_cast<std::int64_t>(1e9 / scene.rates.visual_hz)),
      feed_(bus, presence, deformer),
      surfaces_(bus, deformer),
      range_(scene, deformer) {
  presence_.set_clock(&clock_);
}

void DeformLoop::publish(bool all) {
  if (deformer_.fresh()) {
    const std::int64_t begin = now_ns();
    deformer_.deform();
    report_.deform.record(now_ns() - begin);
  }
  for (int b = 0; b < deformer_.bodies(); ++b)
    if (all || deformer_.changed(b))
      surfaces_.publish(b, {deformer_.shape(b).origin(), deformer_.surface(b).position, deformer_.surface(b).normal},
                        {deformer_.run(), deformer_.step(), deformer_.sense_ns()});
  ++report_.frames;
  if (all)
    for (const std::string& said : range_.look(deformer_)) log_warning(said);
}

// Peers, the death of the haptic node and the status: what is not for every frame.
void DeformLoop::keep_house(std::int64_t now) {
  for (const std::string& said : presence_.watch()) log_info(said);
  for (const std::string& said : link_.look(presence_, now)) log_warning(said);
  feed_.watch_haptic(now);
  if (now - last_status_ns_ < 1'000'000'000) return;
  const double rate = last_status_ns_ == 0 ? 0
                                           : 1e9 * static_cast<double>(report_.frames - last_frames_) /
                                                 static_cast<double>(now - last_status_ns_);
  const std::string silence = link_.silence("haptic", now);
  const Percentiles latency = percentiles_us(recent_latency_);
  presence_.announce(rate, report_.frames, 0, latency.p50, latency.p99, silence.empty() ? range_.warning() : silence);
  recent_latency_.clear();
  last_status_ns_ = now;
  last_frames_ = report_.frames;
}

void DeformLoop::record_latency(std::int64_t ns) {
  report_.latency.record(ns);
  recent_latency_.record(ns);
}

const DeformReport& DeformLoop::run(double seconds) {
  const std::int64_t begin = now_ns();
  std::int64_t next_frame = begin, next_house = begin;
  while (!shutdown_requested()) {
    std::int64_t now = now_ns();
    if (seconds > 0 && 1e-9 * static_cast<double>(now - begin) >= seconds) break;
    if (now >= next_house) {
      keep_house(now);
      next_house = now + 50'000'000;
    }
    if (next_frame > now) bus_.wait(std::chrono::nanoseconds(next_frame - now));
    clock_.follow();
    const bool news = feed_.take();
    now = now_ns();
    const bool frame = now >= next_frame;
    // What the network has not carried yet is not followed by more of the same, or it would never carry anything.
    if (!frame && !(news && surfaces_.delivered())) continue;
    publish(frame);
    if (news) record_latency(surfaces_.last_publish_ns() - clock_.to_own(deformer_.sense_ns()));
    if (frame) next_frame = now + frame_ns_;
  }
  report_.refused = feed_.refused() + bus_.refused();
  report_.seconds = 1e-9 * static_cast<double>(now_ns() - begin);
  return report_;
}

}  // namespace palpate
