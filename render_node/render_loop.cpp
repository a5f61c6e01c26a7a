#include "render_node/render_loop.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/log/log.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/shutdown.hpp"

namespace palpate {

RenderLoop::RenderLoop(const Scene& scene, Stage stage, SurfaceSource& source, Bus& bus, Presence& presence,
                       Renderer& renderer)
    : rate_wanted_hz_(scene.rates.visual_hz),
      show_(scene, std::move(stage), source, bus, presence),
      source_(source),
      bus_(bus),
      presence_(presence),
      renderer_(renderer),
      clock_(bus, presence.node()),
      link_(bus),
      pictures_(bus.writer(topics::picture_state)) {
  presence_.set_clock(&clock_);
  picture_.node = presence.node();
}

std::vector<std::string> RenderLoop::state_lines() const {
  std::vector<std::string> lines;
  double haptic_hz = 0;
  for (const auto& [name, peer] : presence_.peers())
    if (peer.accepted && peer.status.role == "haptic") haptic_hz = std::max(haptic_hz, peer.status.rate_hz);
  if (!presence_.matched("haptic")) lines.push_back("waiting for a haptic node");
  for (const char* role : {"haptic", "deform"})
    if (const std::string silence = link_.silence(role, now_ns()); !silence.empty()) lines.push_back(silence);
  if (const std::string warning = range_warning(); !warning.empty()) lines.push_back(warning);
  lines.push_back(fmt::format("haptic {:.0f} Hz   visual {:.0f} Hz", haptic_hz, rate_hz_));
  lines.push_back(shown_steps_ > 0 ? fmt::format("tool to picture {:.1f} ms (p99 {:.1f})", 1e-3 * shown_latency_.p50,
                                                 1e-3 * shown_latency_.p99)
                                   : std::string("nothing new to show"));
  return lines;
}

/// By this process, or by the deform node.
std::string RenderLoop::range_warning() const {
  if (source_.range()) return source_.range()->warning();
  const Presence::Peer* deform = presence_.holder("deform");
  return deform ? deform->status.text : std::string();
}

void RenderLoop::add_to_film(std::int64_t since_begin) {
  const long due = static_cast<long>(1e-9 * static_cast<double>(since_begin) * film_->rate()) + 1 - film_->frames();
  if (due <= 0) return;
  if (film_->full()) {
    ++report_.film.skipped;
    return;
  }
  film_->add(image_, static_cast<int>(due));
  report_.film.repeated += static_cast<std::uint64_t>(due - 1);
  report_.film.longest_stand = std::max(report_.film.longest_stand, static_cast<double>(due) / film_->rate());
}

void RenderLoop::keep_house(std::int64_t now) {
  for (const std::string& said : presence_.watch()) log_info(said);
  for (const std::string& said : link_.look(presence_, now)) log_warning(said);
  if (now - last_status_ns_ < kNsPerS) return;
  rate_hz_ = 1e9 * static_cast<double>(report_.frames - last_frames_) / static_cast<double>(now - last_status_ns_);
  shown_latency_ = percentiles_us(recent_latency_);
  shown_steps_ = recent_latency_.count();
  pace_.look(passes_, report_.missed);
  if (!pace_.news().empty()) log_warning(pace_.news());
  const std::string silence = link_.silence("haptic", now), warning = silence.empty() ? pace_.status() : silence;
  presence_.announce(rate_hz_, report_.frames, report_.missed, shown_latency_.p50, shown_latency_.p99,
                     warning.empty() && source_.range() ? source_.range()->warning() : warning);
  recent_latency_.clear();
  last_status_ns_ = now;
  last_frames_ = report_.frames;
}

void RenderLoop::step(std::int64_t begin) {
  clock_.follow();
  const bool news = show_.take();
  source_.watch(now_ns());
  show_.tell(state_lines());
  const std::int64_t drawing = now_ns();
  renderer_.draw(show_.frame(), image_);
  const std::int64_t done = now_ns();
  report_.draw.record(done - drawing);
  ++report_.frames;
  if (news) tell_picture(done);
  if (film_) add_to_film(done - begin);
}

/// A step is seen for the first time.
void RenderLoop::tell_picture(std::int64_t done) {
  const SurfaceSource::Moment moment = source_.moment();
  const std::int64_t latency = done - clock_.to_own(moment.sense_ns);
  report_.latency.record(latency);
  recent_latency_.record(latency);
  ++picture_.seq;
  picture_.run = moment.run;
  picture_.step = moment.step;
  picture_.sense_ns = moment.sense_ns;
  picture_.publish_ns = done;
  pictures_->write(picture_);
}

const RenderReport& RenderLoop::run(double seconds) {
  PeriodicTimer timer(rate_wanted_hz_, 0);
  renderer_.draw(show_.frame(), image_);  // compiles the shaders, before the clock runs
  const std::int64_t begin = now_ns();
  last_status_ns_ = begin;
  timer.start();
  std::int64_t next_house = begin;
  presence_.announce(0, 0, 0, 0, 0);
  while (!shutdown_requested()) {
    const std::int64_t now = now_ns();
    if (seconds > 0 && 1e-9 * static_cast<double>(now - begin) >= seconds) break;
    if (now >= next_house) {
      keep_house(now);
      next_house = now + 50'000'000;
    }
    step(begin);
    ++passes_;
    timer.wait();
    report_.missed = timer.statistics().skipped;
  }
  report_.seconds = 1e-9 * static_cast<double>(now_ns() - begin);
  report_.behind = pace_.looks_behind();
  report_.peak_force = show_.peak_force();
  report_.refused = show_.refused() + source_.refused() + bus_.refused();
  return report_;
}

}  // namespace palpate
