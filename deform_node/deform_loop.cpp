#include "deform_node/deform_loop.hpp"

#include <spdlog/spdlog.h>

#include <cstring>

#include "common/realtime/clock.hpp"
#include "common/realtime/shutdown.hpp"

namespace palpate {

DeformLoop::DeformLoop(Deformer& deformer, Bus& bus, Presence& presence, double visual_hz)
    : deformer_(deformer),
      bus_(bus),
      presence_(presence),
      frame_ns_(static_cast<std::int64_t>(1e9 / visual_hz)),
      feed_(bus, presence, deformer),
      surfaces_(bus.writer(topics::surface_state)),
      messages_(deformer.bodies()) {
  for (int b = 0; b < deformer.bodies(); ++b) {
    messages_[b].body = static_cast<std::uint32_t>(b);
    messages_[b].position.resize(3 * deformer.surface(b).position.size());
    messages_[b].normal.resize(messages_[b].position.size());
  }
}

void DeformLoop::publish(std::int64_t now) {
  deformer_.deform();
  report_.deform.record(now_ns() - now);
  for (int b = 0; b < deformer_.bodies(); ++b) {
    SurfaceState& m = messages_[b];
    const DeformedSurface& surface = deformer_.surface(b);
    std::memcpy(m.position.data(), surface.position.data(), m.position.size() * sizeof(float));
    std::memcpy(m.normal.data(), surface.normal.data(), m.normal.size() * sizeof(float));
    m.run = deformer_.run();
    m.step = deformer_.step();
    m.sense_ns = deformer_.sense_ns();
    m.publish_ns = now_ns();
    ++m.seq;
    surfaces_->write(m);
  }
  ++report_.frames;
}

// Peers, the death of the haptic node and the status: what is not for every frame.
void DeformLoop::keep_house(std::int64_t now) {
  for (const std::string& said : presence_.watch()) spdlog::info("{}", said);
  feed_.watch_haptic();
  if (now - last_status_ns_ < 1'000'000'000) return;
  const double rate = last_status_ns_ == 0 ? 0 : 1e9 * static_cast<double>(report_.frames - last_frames_) / static_cast<double>(now - last_status_ns_);
  presence_.announce(rate, report_.frames, 0, 1e-3 * static_cast<double>(report_.latency.percentile(0.5)), 1e-3 * static_cast<double>(report_.latency.percentile(0.99)));
  last_status_ns_ = now;
  last_frames_ = report_.frames;
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
    const bool news = feed_.take();
    now = now_ns();
    if (!news && now < next_frame) continue;
    publish(now);
    if (news) report_.latency.record(messages_.empty() ? 0 : messages_.back().publish_ns - deformer_.sense_ns());
    next_frame = now + frame_ns_;
  }
  report_.refused = feed_.refused();
  report_.seconds = 1e-9 * static_cast<double>(now_ns() - begin);
  return report_;
}

}  // namespace palpate
