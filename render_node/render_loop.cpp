#include "render_node/render_loop.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "common/realtime/clock.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/shutdown.hpp"

namespace palpate {
namespace {

double magnitude(const ForceState& f) {
  return std::hypot(f.force[0], f.force[1], f.force[2]);
}

std::string describe(const std::string& tool, const ForceState& f) {
  std::string words = fmt::format("{}  {:.2f} N", tool, magnitude(f));
  if (f.grip != 0) words += fmt::format("  grip {:.0f} N mm", 1e3 * f.grip);
  if (f.flags & fault) return words + "  fault: force off";
  if (f.flags & (force_limited | slew_limited)) words += "  limited";
  return words;
}

void describe(const TaskRecord& task, std::vector<std::string>& lines) {
  lines.push_back(fmt::format("inserted {:.0f} mm, deepest {:.0f} mm in {:.1f} s", 1e3 * task.inserted,
                              1e3 * task.deepest, task.inserting_s));
  lines.push_back(fmt::format("wall contacts {}   drops {}   largest force {:.2f} N", task.wall_contacts, task.drops,
                              task.max_force));
}

bool tells_task(const Body& body) {
  return std::visit([](const auto& spec) { return has_task(spec); }, body);
}

}  // namespace

RenderLoop::RenderLoop(const Scene& scene, Stage stage, SurfaceSource& source, Bus& bus, Presence& presence,
                       Renderer& renderer)
    : scene_(scene),
      stage_(std::move(stage)),
      source_(source),
      bus_(bus),
      presence_(presence),
      renderer_(renderer),
      clock_(bus, presence.node()),
      link_(bus),
      pictures_(bus.writer(topics::picture_state)),
      tools_(bus.reader(topics::tool_state)),
      forces_(bus.reader(topics::force_state)),
      latest_force_(scene.tools.size()) {
  presence_.set_clock(&clock_);
  picture_.node = presence.node();
  if (std::ranges::any_of(scene.bodies, tells_task)) tasks_ = bus.reader(topics::task_record);
}

void RenderLoop::take() {
  news_ = source_.update();
  if (topology_) follow_cuts();
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    const SurfaceSource::Shape shape = source_.shape(static_cast<int>(b));
    stage_.set_surface(static_cast<int>(b), shape.position, shape.normal);
  }
  while (const auto tool = tools_->take()) report_.refused += !(presence_.accepts(tool->run) && stage_.set_tool(*tool));
  while (const auto force = forces_->take()) {
    const bool good = force->tool < latest_force_.size() && presence_.accepts(force->run);
    if (good) latest_force_[force->tool] = *force;
    report_.refused += !good;
  }
  while (const auto task = tasks_ ? tasks_->take() : std::nullopt) {
    const bool good =
        task->body < scene_.bodies.size() && tells_task(scene_.bodies[task->body]) && presence_.accepts(task->run);
    if (good) latest_task_[task->body] = *task;
    report_.refused += !good;
  }
}

void RenderLoop::follow_cuts() {
  for (const int body : topology_->take()) stage_.set_triangles(body, topology_->triangles(body));
}

void RenderLoop::write_overlay() {
  std::vector<std::string> lines{scene_.title.empty() ? scene_.file.stem().string() : scene_.title};
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
  for (const auto& [body, task] : latest_task_) describe(task, lines);
  double strongest = 0, full = 1;
  for (std::size_t i = 0; i < latest_force_.size(); ++i) {
    lines.push_back(describe(scene_.tools[i].name, latest_force_[i]));
    strongest = std::max(strongest, magnitude(latest_force_[i]));
    full = i == 0 ? scene_.tools[i].max_force : std::max(full, scene_.tools[i].max_force);
  }
  std::optional<Gauge> gauge;
  if (!latest_force_.empty()) gauge = Gauge{strongest, full};
  stage_.set_overlay(std::move(lines), gauge);
  if (strongest > 1.01 * report_.peak_force) {
    report_.peak_force = strongest;
    best_ = stage_;
  }
}

/// By this process, or by the deform node.
std::string RenderLoop::range_warning() const {
  if (source_.range()) return source_.range()->warning();
  const Presence::Peer* deform = presence_.holder("deform");
  return deform ? deform->status.text : std::string();
}

void RenderLoop::add_to_film(std::int64_t since_begin) {
  const long due = static_cast<long>(1e-9 * static_cast<double>(since_begin) * film_->rate()) + 1 - film_->frames();
  if (due > 0 && !film_->full()) film_->add(image_, static_cast<int>(due));
}

void RenderLoop::keep_house(std::int64_t now) {
  for (const std::string& said : presence_.watch()) spdlog::info("{}", said);
  for (const std::string& said : link_.look(presence_, now)) spdlog::warn("{}", said);
  if (now - last_status_ns_ < kNsPerS) return;
  rate_hz_ = 1e9 * static_cast<double>(report_.frames - last_frames_) / static_cast<double>(now - last_status_ns_);
  shown_latency_ = percentiles_us(recent_latency_);
  shown_steps_ = recent_latency_.count();
  pace_.look(passes_, report_.missed);
  if (!pace_.news().empty()) spdlog::warn("{}", pace_.news());
  const std::string silence = link_.silence("haptic", now), warning = silence.empty() ? pace_.status() : silence;
  presence_.announce(rate_hz_, report_.frames, report_.missed, shown_latency_.p50, shown_latency_.p99,
                     warning.empty() && source_.range() ? source_.range()->warning() : warning);
  recent_latency_.clear();
  last_status_ns_ = now;
  last_frames_ = report_.frames;
}

void RenderLoop::step(std::int64_t begin) {
  clock_.follow();
  take();
  write_overlay();
  const std::int64_t drawing = now_ns();
  renderer_.draw(stage_.frame(), image_);
  const std::int64_t done = now_ns();
  report_.draw.record(done - drawing);
  ++report_.frames;
  if (news_) tell_picture(done);
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
  PeriodicTimer timer(scene_.rates.visual_hz, 0);
  renderer_.draw(stage_.frame(), image_);  // compiles the shaders, before the clock runs
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
  report_.refused += source_.refused() + bus_.refused();
  return report_;
}

}  // namespace palpate
