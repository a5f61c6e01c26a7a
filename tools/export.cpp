#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <stdexcept>

#include "common/bus/log_reader.hpp"
#include "common/bus/print.hpp"
#include "common/bus/topic_named.hpp"
#include "idl/topics.hpp"
#include "tools/mcap/export_mcap.hpp"
#include "tools/shared/commands.hpp"

namespace palpate {
namespace {

struct ExportOptions {
  std::string log, topic, file;
  bool csv = false, json = false, mcap = false;
};

/// A file, or the standard output.
class Output {
 public:
  explicit Output(const std::string& file) : name_(file), file_(file.empty() ? stdout : std::fopen(file.c_str(), "w")) {
    if (!file_) throw std::runtime_error(fmt::format("{}: cannot write", file));
  }
  ~Output() {
    if (file_ != stdout) std::fclose(file_);
  }
  Output(const Output&) = delete;
  void line(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), file_);
    std::fputc('\n', file_);
  }
  void finish() {
    if (std::fflush(file_) != 0 || std::ferror(file_))
      throw std::runtime_error(fmt::format("{}: cannot write", name_.empty() ? "standard output" : name_));
  }

 private:
  std::string name_;
  std::FILE* file_;
};

template <class M>
std::uint64_t export_topic(const ExportOptions& o, const Topic<M>& topic, LogReader& reader, Output& out) {
  if (!o.json) out.line("receive_ns," + csv_header<M>());
  std::uint64_t count = 0;
  LogEvent event;
  M message;
  while (reader.next(event)) {
    if (!event.read(topic, message)) continue;
    out.line(o.json ? fmt::format("{{\"receive_ns\":{},\"message\":{}}}", event.receive_ns, to_json(message))
                    : fmt::format("{},{}", event.receive_ns, csv_row(message)));
    ++count;
  }
  return count;
}

void write_mcap(const ExportOptions& o, const std::string& topic) {
  if (o.file.empty()) throw std::runtime_error("export: --mcap needs a file: give -o FILE.mcap");
  const std::uint64_t count = export_mcap(o.log, topic, o.file);
  if (count == 0) throw std::runtime_error(fmt::format("{}: holds no such sample", o.log));
  fmt::print("{}: {} messages\n", o.file, count);
}

void run(const ExportOptions& o) {
  if (o.mcap && o.topic.empty()) return write_mcap(o, "");
  if (o.topic.empty()) throw std::runtime_error("export: CSV and JSON lines are of one topic: give --topic");
  const std::string name = topic_named(o.topic);
  LogReader reader(o.log);
  topics::for_each([&](const auto& topic) {
    if (name != topic.name) return;
    if (o.mcap) return write_mcap(o, name);
    Output out(o.file);
    const std::uint64_t count = export_topic(o, topic, reader, out);
    out.finish();
    if (!reader.damage_text().empty()) fmt::print(stderr, "palpate: {}\n", reader.damage_text());
    if (count == 0) throw std::runtime_error(fmt::format("{}: holds no sample of {}", o.log, name));
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
