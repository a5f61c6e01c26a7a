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
  std::uint64_t samples = 0, kept = 0;
};

/// Programs say who is there and what the time is whether or not a system runs.
template <class M>
constexpr bool kOfARun = !std::same_as<M, NodeStatus> && !std::same_as<M, ClockProbe> && !std::same_as<M, ClockAnswer>;

template <class... M>
auto make_tracks(Bus& bus, const std::tuple<Topic<M>...>& all) {
  return std::apply(
      [&](const auto&... topic) {
        return std::tuple{Track<M>{topic, bus.reader(topic, Keep::all)}...};
      },
      all);
}
using Tracks = decltype(make_tracks(std::declval<Bus&>(), topics::all));

LogHeader make_header(const RecorderSettings& settings) {
  LogHeader header;
  header.schema = schema_text();
  header.version = settings.version;
  header.host = host_name();
  header.start_wall_ns = wall_ns();
  header.start_monotonic_ns = now_ns();
  return header;
}

constexpr int kLastPasses = 10;
constexpr std::int64_t kShortPassNs = 5'000'000;

}  // namespace

class Recorder::Impl {
 public:
  Impl(Bus& bus, const RecorderSettings& settings)
      : bus_(bus),
        files_(settings.files),
        thinning_of_(settings.thinning),
        log_(settings.file, make_header(settings), WhenFull::lose, Naming::later),
        tracks_(make_tracks(bus, topics::all)),
        status_writer_(bus.writer(topics::node_status)) {
    status_.node = fmt::format("recorder {}@{}", getpid(), host_name());
    status_.role = "recorder";
    status_.version = settings.version;
  }

  void step(std::chrono::nanoseconds timeout) {
    bus_.wait(timeout);
    drain();
    if (const std::int64_t now = now_ns(); now >= next_status_ns_) publish_status(now);
  }

  LogStatus log_status() const { return log_.status(); }

  RecorderReport report() const {
    RecorderReport report;
    report.log = log_.status();
    report.has_scene = !status_.scene_hash.empty();
    report.has_log = log_.has_name();
    std::apply(
        [&](const auto&... track) {
          const auto add = [&](const auto& t) {
            if (t.samples > 0)
              report.topics[t.topic.name] = {t.samples, t.kept, t.sequence.missing(), t.reader->invalid()};
          };
          (add(track), ...);
        },
        tracks_);
    return report;
  }

  // Topics are heard out one after another: where a pass takes long, the first lack what the last ones have.
  RecorderReport finish() {
    for (int pass = 0; pass < kLastPasses; ++pass) {
      const std::int64_t begin = now_ns();
      drain();
      if (now_ns() - begin < kShortPassNs) break;
    }
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
      if constexpr (std::same_as<M, SceneText>) status_.scene_hash = message->scene_hash;
      if constexpr (kOfARun<M>) log_.give_name();
      if (thinning_.keeps(*message)) {
        log_.write(track.topic.name, receive_ns, *message);
        ++track.kept;
      }
      if constexpr (std::same_as<M, SceneText>) learn_scene(message->text, receive_ns);
    }
  }

  void learn_scene(const std::string& scene, std::int64_t receive_ns) {
    write_files(scene, receive_ns);
    if (!thinning_of_) return;
    thinning_ = thinning_of_(scene);
    log_.write(kThinnedChannel, receive_ns, LogThinned{thinning_.steps});
  }

  void write_files(const std::string& scene, std::int64_t receive_ns) {
    if (!files_ || scene == scene_with_files_) return;
    scene_with_files_ = scene;
    for (const LogFile& file : files_(scene)) log_.write(kFileChannel, receive_ns, file);
  }

  void publish_status(std::int64_t now) {
    next_status_ns_ = now + kNsPerS;
    ++status_.seq;
    status_.stamp_ns = now;
    std::apply([&](const auto&... track) { status_.ticks = (track.samples + ...); }, tracks_);
    const LogStatus log = log_.status();
    status_.missed = log.lost;
    status_.text = loss_text(log);
    status_writer_->write(status_);
  }

  Bus& bus_;
  std::function<std::vector<LogFile>(const std::string&)> files_;
  std::function<Thinning(const std::string&)> thinning_of_;
  Thinning thinning_;
  std::string scene_with_files_;  ///< whose files are in the log
  LogWriter log_;
  Tracks tracks_;
  std::unique_ptr<Writer<NodeStatus>> status_writer_;
  NodeStatus status_;
  std::int64_t next_status_ns_ = 0;
};

Recorder::Recorder(Bus& bus, const RecorderSettings& settings) : impl_(std::make_unique<Impl>(bus, settings)) {}
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
