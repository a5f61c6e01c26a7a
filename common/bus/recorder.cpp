#include "common/bus/recorder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <tuple>

#include "common/bus/sequence.hpp"
#include "common/realtime/clock.hpp"

namespace palpate {
namespace {

std::string host_name() {
  char name[256] = "";
  gethostname(name, sizeof name - 1);
  return name;
}

/// A topic as the recorder sees it.
template <class M>
struct Track {
  Topic<M> topic;
  std::unique_ptr<Reader<M>> reader;
  SequenceCheck sequence{};
  std::uint64_t samples = 0;
};

template <class... M>
auto make_tracks(Bus& bus, const std::tuple<Topic<M>...>& all) {
  return std::apply(
      [&](const auto&... topic) {
        return std::tuple{Track<M>{topic, bus.reader(topic, Keep::all)}...};
      },
      all);
}
using Tracks = decltype(make_tracks(std::declval<Bus&>(), topics::all));

struct Held {
  std::string channel;
  std::int64_t receive_ns;
  Bytes payload;
};

}  // namespace

class Recorder::Impl {
 public:
  Impl(Bus& bus, const RecorderSettings& settings)
      : bus_(bus),
        settings_(settings),
        log_(settings.file),
        tracks_(make_tracks(bus, topics::all)),
        status_writer_(bus.writer(topics::node_status)),
        start_ns_(now_ns()) {
    header_.schema = schema_text();
    header_.version = settings.version;
    header_.host = host_name();
    header_.start_wall_ns = wall_ns();
    header_.start_monotonic_ns = start_ns_;
    status_.node = fmt::format("recorder {}@{}", getpid(), header_.host);
    status_.role = "recorder";
    status_.version = settings.version;
  }

  void step(std::chrono::nanoseconds timeout) {
    bus_.wait(timeout);
    drain();
    const std::int64_t now = now_ns();
    if (!begun_ &&
        (has_scene_ || now - start_ns_ > std::chrono::nanoseconds(settings_.scene_patience).count()))
      begin();
    if (now >= next_status_ns_) publish_status(now);
  }

  LogStatus log_status() const { return log_.status(); }

  RecorderReport report() const {
    RecorderReport report;
    report.log = log_.status();
    report.has_scene = has_scene_;
    std::apply(
        [&](const auto&... track) {
          const auto add = [&](const auto& t) {
            if (t.samples > 0)
              report.topics[t.topic.name] = {t.samples, t.sequence.missing(), t.reader->invalid()};
          };
          (add(track), ...);
        },
        tracks_);
    return report;
  }

  RecorderReport finish() {
    drain();
    if (!begun_) begin();
    RecorderReport result = report();
    result.log = log_.finish();
    return result;
  }

 private:
  void drain() {
    std::apply([&](auto&... track) { (drain_one(track), ...); }, tracks_);
  }

  template <class M>
  void drain_one(Track<M>& track) {
    while (const auto message = track.reader->take()) {
      const std::int64_t receive_ns = now_ns();
      track.sequence.add(*message);
      ++track.samples;
      if constexpr (std::same_as<M, SceneText>) take_scene(*message);
      Bytes payload;
      encode(*message, payload);
      if (begun_) {
        log_.write_payload(track.topic.name, receive_ns, payload);
      } else {
        held_.push_back({track.topic.name, receive_ns, std::move(payload)});
      }
    }
  }

  void take_scene(const SceneText& scene) {
    has_scene_ = true;
    header_.scene_hash = scene.scene_hash;
    header_.scene = scene.text;
    header_.code_path = scene.code_path;
  }

  /// Writes the header, then what was held back for it.
  void begin() {
    log_.write(header_channel, header_.start_monotonic_ns, header_);
    for (const Held& held : held_) log_.write_payload(held.channel, held.receive_ns, held.payload);
    held_.clear();
    held_.shrink_to_fit();
    begun_ = true;
  }

  void publish_status(std::int64_t now) {
    next_status_ns_ = now + ns_per_s;
    ++status_.seq;
    status_.stamp_ns = now;
    status_.scene_hash = header_.scene_hash;
    std::apply([&](const auto&... track) { status_.ticks = (track.samples + ...); }, tracks_);
    const LogStatus log = log_.status();
    status_.missed = log.lost;
    status_.text = loss_text(log);
    status_writer_->write(status_);
  }

  Bus& bus_;
  RecorderSettings settings_;
  LogWriter log_;
  Tracks tracks_;
  std::unique_ptr<Writer<NodeStatus>> status_writer_;
  LogHeader header_;
  NodeStatus status_;
  std::vector<Held> held_;
  std::int64_t start_ns_, next_status_ns_ = 0;
  bool begun_ = false, has_scene_ = false;
};

Recorder::Recorder(Bus& bus, const RecorderSettings& settings)
    : impl_(std::make_unique<Impl>(bus, settings)) {}
Recorder::~Recorder() = default;
void Recorder::step(std::chrono::nanoseconds timeout) {
  impl_->step(timeout);
}
RecorderReport Recorder::report() const {
  return impl_->report();
}
LogStatus Recorder::log_status() const {
  return impl_->log_status();
}
RecorderReport Recorder::finish() {
  return impl_->finish();
}

std::uint64_t RecorderReport::missing() const {
  std::uint64_t sum = 0;
  for (const auto& [name, topic] : topics) sum += topic.missing;
  return sum;
}

std::string loss_text(const LogStatus& status) {
  if (status.lost == 0) return {};
  return fmt::format("log: {}, lost {} message{}", status.error, status.lost, status.lost == 1 ? "" : "s");
}

}  // namespace palpate
