#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>

#include "common/bus/log_reader.hpp"
#include "common/bus/print.hpp"
#include "common/bus/runs_at_once.hpp"
#include "common/bus/topic_named.hpp"
#include "common/files/atomic_file.hpp"
#include "common/files/ending.hpp"
#include "common/realtime/shutdown.hpp"
#include "idl/topics.hpp"
#include "tools/mcap/export_mcap.hpp"
#include "tools/shared/commands.hpp"

namespace palpate {
namespace {

struct ExportOptions {
  std::string log, topic, file;
  bool csv = false, json = false, mcap = false;
};

/// A file, which is there once finish() returns, or the standard output.
class Output {
 public:
  explicit Output(const std::string& file) : name_(file) {
    if (file.empty()) return;
    whole_.emplace(file);
    file_ = std::fopen(whole_->handle().c_str(), "w");
    require(file_);
  }
  ~Output() {
    if (file_ != stdout) std::fclose(file_);
  }
  Output(const Output&) = delete;
  void line(const std::string& text) {
    require(std::fwrite(text.data(), 1, text.size(), file_) == text.size() && std::fputc('\n', file_) != EOF);
  }
  void finish() {
    require(std::fflush(file_) == 0);
    if (whole_) whole_->commit();
  }

 private:
  void require(bool good) const {
    if (good) return;
    throw std::runtime_error(
        fmt::format("{}: cannot be written: {}", name_.empty() ? "standard output" : name_, std::strerror(errno)));
  }

  std::string name_;
  std::optional<AtomicFile> whole_;
  std::FILE* file_ = stdout;
};

void say_two_runs(const ExportOptions& o, const RunsAtOnce& runs) {
  if (const std::string two = runs.text(); !two.empty()) fmt::print(stderr, "palpate: {}: {}\n", o.log, two);
}

template <class M>
std::uint64_t export_topic(const ExportOptions& o, const Topic<M>& topic, LogReader& reader, Output& out) {
  if (!o.json) out.line("receive_ns," + csv_header<M>());
  std::uint64_t count = 0;
  LogEvent event;
  RunsAtOnce runs;
  M message;
  while (reader.next(event)) {
    stop_if_interrupted();
    runs.add(event);
    if (!event.read(topic, message)) continue;
    out.line(o.json ? fmt::format("{{\"receive_ns\":{},\"message\":{}}}", event.receive_ns, to_json(message))
                    : fmt::format("{},{}", event.receive_ns, csv_row(message)));
    ++count;
  }
  say_two_runs(o, runs);
  return count;
}

void write_mcap(const ExportOptions& o, const std::string& topic) {
  if (o.file.empty()) throw std::runtime_error("export: --mcap needs a file: give -o FILE.mcap");
  fmt::print("{}: {} messages\n", o.file, export_mcap(o.log, topic, o.file));
}

/// A file's ending says what is in it.
void check_ending(const ExportOptions& o) {
  const bool named = has_ending(o.file, ".mcap");
  if (o.mcap && !named) throw std::runtime_error(fmt::format("export: {} does not end in .mcap", o.file));
  if (named && !o.mcap) throw std::runtime_error(fmt::format("export: {} ends in .mcap: give --mcap too", o.file));
}

void run(const ExportOptions& o) {
  catch_shutdown_signals();
  if (!o.file.empty()) check_ending(o);
  if (o.mcap && o.topic.empty()) return write_mcap(o, "");
  if (o.topic.empty()) throw std::runtime_error("export: CSV and JSON lines are of one topic: give --topic");
  const std::string name = topic_named(o.topic);
  LogReader reader(o.log);
  topics::for_each([&](const auto& topic) {
    if (name != topic.name) return;
    if (o.mcap) return write_mcap(o, name);
    Output out(o.file);
    const std::uint64_t count = export_topic(o, topic, reader, out);
    if (!reader.damage_text().empty()) fmt::print(stderr, "palpate: {}\n", reader.damage_text());
    if (count == 0) throw std::runtime_error(fmt::format("{}: holds no sample of {}", o.log, name));
    out.finish();
  });
}

}  // namespace

void add_export_command(cli::Command& app) {
  auto o = std::make_shared<ExportOptions>();
  cli::Command command = app.add_command("export", "Write one topic of a log as CSV or JSON lines, or a log as MCAP");
  command.add_option("LOG", o->log, "LCM event log").required();
  command.add_option("--topic", o->topic, "Topic, with or without palpate/ before it; MCAP without one has all");
  command.add_flag("--csv", o->csv, "CSV (the default): one line a sample, sequences as quoted JSON");
  command.add_flag("--jsonl", o->json, "One JSON object a line").excludes({"--csv"});
  command.add_flag("--mcap", o->mcap, "MCAP for Foxglove and other readers: messages as CDR, types as IDL; with -o")
      .excludes({"--csv", "--jsonl"});
  command.add_option("-o,--output", o->file, "File (default: standard output)")
      .output_file("", {".csv", ".json", ".mcap"});
  command.examples({"palpate export session.lcmlog --topic force_state --csv -o force.csv",
                    "palpate export session.lcmlog --mcap -o session.mcap"});
  command.does([o] { run(*o); });
}

}  // namespace palpate
