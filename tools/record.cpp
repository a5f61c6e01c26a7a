#include <fmt/format.h>
#include <unistd.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "common/bus/recorder.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/shutdown.hpp"
#include "tools/logs/log_files.hpp"
#include "tools/shared/commands.hpp"
#include "tools/shared/network_options.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;

constexpr double kShort = 600;  // [s]
constexpr const char *kEverything = "everything", *kEnough = "enough";

struct RecordOptions {
  SystemNetwork network;
  std::string file;
  double seconds = 0;
  std::string keep;
  bool supervised = false, json = false;

  /// Unless it is told: everything of a recording whose end is near.
  bool keeps_everything() const { return keep.empty() ? seconds > 0 && seconds <= kShort : keep == kEverything; }
};

std::string default_file() {
  const std::time_t now = std::time(nullptr);
  char name[64];
  std::strftime(name, sizeof name, "palpate-%Y%m%d-%H%M%S.lcmlog", std::localtime(&now));
  return name;
}

RecordedTopic sum_of(const RecorderReport& report) {
  RecordedTopic sum;
  for (const auto& [name, topic] : report.topics) {
    sum.samples += topic.samples;
    sum.kept += topic.kept;
  }
  return sum;
}

nlohmann::ordered_json summary(const RecordOptions& o, const RecorderReport& report, double seconds) {
  nlohmann::ordered_json topics = nlohmann::ordered_json::object();
  for (const auto& [name, topic] : report.topics)
    topics[name] = {
        {"samples", topic.samples}, {"kept", topic.kept}, {"missing", topic.missing}, {"invalid", topic.invalid}};
  const RecordedTopic sum = sum_of(report);
  return {{"node", "recorder"},        {"file", o.file},
          {"seconds", seconds},        {"messages", sum.samples},
          {"kept", sum.kept},          {"missing", report.missing()},
          {"lost", report.log.lost},   {"bytes", report.log.bytes},
          {"error", report.log.error}, {"scene", report.has_scene},
          {"topics", topics}};
}

void print_report(const RecordOptions& o, const RecorderReport& report, double seconds) {
  const auto kept = [](const RecordedTopic& topic) {
    return topic.kept < topic.samples ? fmt::format(", {} of them kept", topic.kept) : std::string();
  };
  const RecordedTopic sum = sum_of(report);
  fmt::print("{}: {:.1f} s, {} messages{}, {:.1f} MB\n", o.file, seconds, sum.samples, kept(sum),
             1e-6 * static_cast<double>(report.log.bytes));
  for (const auto& [name, topic] : report.topics) {
    fmt::print("  {:24} {:9}{}", name, topic.samples, kept(topic));
    if (topic.missing > 0) fmt::print("  {} never arrived", topic.missing);
    if (topic.invalid > 0) fmt::print("  {} invalid", topic.invalid);
    fmt::print("\n");
  }
  if (!report.has_scene) fmt::print("  no haptic node announced its scene: the log holds none\n");
}

/// Says on stderr when messages begin to be lost, and again when more are, at most once a second.
class LossNotice {
 public:
  void look(const LogStatus& status) {
    const std::int64_t now = now_ns();
    if (status.lost == said_ || now < next_) return;
    said_ = status.lost;
    next_ = now + kNsPerS;
    fmt::print(stderr, "palpate: {}\n", loss_text(status));
  }

 private:
  std::uint64_t said_ = 0;
  std::int64_t next_ = 0;
};

void record(RecordOptions& o) {
  if (o.file.empty()) o.file = default_file();
  catch_shutdown_signals();
  const auto bus = make_dds_bus(o.network);
  RecorderSettings settings{.file = o.file, .version = PALPATE_VERSION, .files = [](const std::string& scene) {
                              return files_for_log(scene);
                            }};
  if (!o.keeps_everything()) settings.thinning = thinning_for_log;
  Recorder recorder(*bus, settings);
  if (!o.json)
    fmt::print("{}\n", o.supervised ? "ready" : fmt::format("recording domain {} to {}", o.network.domain, o.file));
  std::fflush(stdout);

  const std::int64_t start = now_ns();
  const auto elapsed = [&] { return 1e-9 * static_cast<double>(now_ns() - start); };
  LossNotice notice;
  while (!shutdown_requested() && (o.seconds <= 0 || elapsed() < o.seconds)) {
    recorder.step(50ms);
    notice.look(recorder.log_status());
  }
  const RecorderReport report = recorder.finish();
  if (o.supervised || o.json) {
    fmt::print("{}\n", summary(o, report, elapsed()).dump());
  } else if (report.has_log) {
    print_report(o, report, elapsed());
  }
  if (!report.has_log) {
    const std::string nothing = o.file + ": nothing was there to record; it is left as it was";
    if (!o.supervised || !shutdown_requested()) throw std::runtime_error(nothing);
    fmt::print(stderr, "palpate: {}\n", nothing);  // a run that is stopped before its first step
  }
  if (report.log.lost > 0) throw std::runtime_error(fmt::format("{}: {}", o.file, loss_text(report.log)));
}

}  // namespace

void add_record_command(cli::Command& app) {
  auto o = std::make_shared<RecordOptions>();
  cli::Command command = app.add_command("record", "Write every topic of a running system into an LCM event log");
  add_system_options(command, o->network, "recorder");
  command.add_option("-o,--output", o->file, "Log file (default: palpate-DATE-TIME.lcmlog)")
      .output_file("", {".lcmlog"});
  command.add_option("--seconds", o->seconds, "Stop after so many seconds (default: Ctrl-C)").positive();
  command
      .add_option("--keep", o->keep,
                  "everything, or enough to verify and to draw: what can be computed again is kept at the rate of "
                  "pictures or not at all (default: enough, everything with --seconds up to 600)")
      .one_of(std::vector<std::string>{kEverything, kEnough});
  command.add_flag("--json", o->json, "Print JSON at the end");
  command.add_flag("--supervised", o->supervised).hidden();
  command.examples({"palpate record --seconds 60 -o out/session.lcmlog"});
  command.does([o, command] {
    take_scene(command, o->network);
    record(*o);
  });
}

}  // namespace palpate
