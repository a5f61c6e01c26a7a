#include <fmt/format.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "common/bus/print.hpp"
#include "common/bus/task_figures.hpp"
#include "common/describe/printable.hpp"
#include "tools/latency/hop_json.hpp"
#include "tools/log_summary.hpp"
#include "tools/shared/commands.hpp"

namespace palpate {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const TopicSummary& t) {
  return {{"samples", t.samples},
          {"rate_hz", t.rate_hz()},
          {"streams", t.streams},
          {"gaps", t.gaps},
          {"missing", t.missing},
          {"repeated", t.repeated},
          {"invalid", t.invalid},
          {"ahead", t.ahead},
          {"sense_to_publish_us", json_of(t.to_publish)},
          {"sense_to_receive_us", json_of(t.to_receive)}};
}

Json json_of(const LogSummary& s, const std::string& file) {
  Json json{{"file", file},
            {"title", s.title},
            {"version", s.header.version},
            {"code_path", s.code_path},
            {"scene_hash", s.header.scene_hash},
            {"host", s.header.host},
            {"start_wall_ns", s.header.start_wall_ns},
            {"seconds", s.seconds},
            {"bytes", s.bytes},
            {"complete", s.footer.has_value() && s.damage.empty()},
            {"lost", s.footer ? Json(s.footer->lost) : Json(nullptr)},
            {"loss_reason", s.footer ? s.footer->error : ""},
            {"thinned_steps", s.thinned_steps},
            {"untold_steps", s.untold_steps},
            {"runs_at_once", s.runs_at_once},
            {"unknown_events", s.unknown}};
  json["damage"] = Json::array();
  for (const LogDamage& d : s.damage)
    json["damage"].push_back({{"offset", d.offset}, {"bytes", d.bytes}, {"tail", d.tail}});
  json["files"] = Json::array();
  for (const LogFile& f : s.files) json["files"].push_back({{"path", f.path}, {"hash", f.hash}, {"bytes", f.size}});
  json["hops_us"] = json_of(s.hops);
  json["tissue_s"] = json_of(s.hops.tissue());
  json["tasks"] = Json::array();
  for (const TaskRecord& task : s.tasks) json["tasks"].push_back(Json::parse(to_json(task)));
  json["topics"] = Json::object();
  for (const auto& [name, topic] : s.topics) json["topics"][name] = json_of(topic);
  return json;
}

std::string local_time(std::int64_t wall_ns) {
  const std::time_t seconds = wall_ns / 1'000'000'000;
  char text[64];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", std::localtime(&seconds));
  return text;
}

void print_table(const LogSummary& s) {
  fmt::print("\n{:24} {:>9} {:>9} {:>6} {:>8} {:>8}  {:>28}\n", "topic", "samples", "Hz", "gaps", "missing", "invalid",
             "sense to log [us] p50/p99/max");
  for (const auto& [name, t] : s.topics) {
    fmt::print("{:24} {:9} {:9.1f} {:6} {:8} {:8}", name, t.samples, t.rate_hz(), t.gaps, t.missing, t.invalid);
    if (t.to_receive.count() > 0) {
      const Percentiles p = percentiles_us(t.to_receive);
      fmt::print("  {:>28}", fmt::format("{:.0f} / {:.0f} / {:.0f}", p.p50, p.p99, p.max));
    }
    fmt::print("\n");
  }
  for (const auto& [name, t] : s.topics)
    if (t.ahead > 0)
      fmt::print("{}: {} of {} say that they were sensed after they were received, and count as 0 us: {}\n", name,
                 t.ahead, t.samples, "their clock is not the recorder's");
}

void print_hops(const LogSummary& s) {
  const auto print = [](const char* name, const Histogram& h) {
    if (h.count() == 0) return;
    const Percentiles p = percentiles_us(h);
    fmt::print("{:24} {:10.1f} {:10.1f} {:10.1f} {:10.1f} {:10.1f}\n", name, p.p50, p.p90, p.p99, p.p999, p.max);
  };
  if (s.hops.force().count() == 0) return;
  fmt::print("\n{:24} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "one way [us]", "p50", "p90", "p99", "p99.9", "max");
  print("tool to force", s.hops.force());
  print("tool to surface", s.hops.surface());
  print("tool to picture", s.hops.picture());
  fmt::print("{}", ahead_text(s.hops));
  if (s.hops.uncertainty_ns() > 0)
    fmt::print("the nodes' clocks are known to {:.1f} us\n", 1e-3 * static_cast<double>(s.hops.uncertainty_ns()));
}

void print_tasks(const LogSummary& s) {
  for (const TaskRecord& task : s.tasks)
    fmt::print("\ntask of catheter {} in run {:016x}\n{}\n", task.body, task.run, fmt::join(task_lines(task), "\n"));
}

std::string scene_line(const LogSummary& s) {
  if (s.header.scene.empty()) return "none in the log";
  return s.title.empty() ? "without a title" : printable(s.title);
}

void print_text(const LogSummary& s, const std::string& file) {
  fmt::print("{}: {:.2f} s, {:.1f} MB\n", file, s.seconds, 1e-6 * static_cast<double>(s.bytes));
  if (s.has_header)
    fmt::print("recorded {} on {} by version {}\n", local_time(s.header.start_wall_ns), printable(s.header.host),
               printable(s.header.version));
  else
    fmt::print("the header is damaged: scene, version and start are unknown\n");
  fmt::print("scene     {}\n", scene_line(s));
  fmt::print("code path {}\n", s.code_path.empty() ? "unknown" : printable(s.code_path));
  for (const LogFile& f : s.files)
    fmt::print("file      {} ({:.2f} MB, {})\n", printable(std::filesystem::path(f.path).filename().string()),
               1e-6 * static_cast<double>(f.size), printable(f.hash));
  if (!s.footer) fmt::print("the recorder did not end in order\n");
  if (s.footer && s.footer->lost > 0)
    fmt::print("the recorder lost {} messages: {}\n", s.footer->lost, printable(s.footer->error));
  if (!s.damage_text.empty()) fmt::print("{}\n", s.damage_text);
  if (s.thinned_steps > 0)
    fmt::print("keeps enough: one in {} steps of what can be computed again, and no surface that can\n",
               s.thinned_steps);
  if (s.untold_steps > 0)
    fmt::print("lacks {} steps that its haptic node told nobody of: its publishing thread had no processor\n",
               s.untold_steps);
  if (s.unknown > 0) fmt::print("{} events of unknown topics\n", s.unknown);
  if (!s.runs_at_once.empty()) fmt::print("{}\n", s.runs_at_once);
  print_table(s);
  print_hops(s);
  fmt::print("{}", text_of(s.hops.tissue()));
  print_tasks(s);
}

}  // namespace

void add_info_command(cli::Command& app) {
  struct Options {
    std::string file;
    bool json = false;
  };
  auto o = std::make_shared<Options>();
  cli::Command command = app.add_command("info", "Rates, gaps and latencies of a topic log");
  command.add_option("LOG", o->file, "LCM event log").required();
  command.add_flag("--json", o->json, "Print JSON");
  command.examples({"palpate info out/liver.lcmlog", "palpate info out/liver.lcmlog --json > out/liver.json"});
  command.does([o] {
    const LogSummary summary = summarise_log(o->file);
    if (o->json) {
      fmt::print("{}\n", json_of(summary, o->file).dump(2, ' ', false, Json::error_handler_t::replace));
    } else {
      print_text(summary, o->file);
    }
  });
}

}  // namespace palpate
