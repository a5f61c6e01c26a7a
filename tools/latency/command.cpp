#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "common/realtime/clock.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/scene/scene.hpp"
#include "tools/latency/beside_ddsperf.hpp"
#include "tools/latency/hop_json.hpp"
#include "tools/latency/observe.hpp"
#include "tools/latency/ways.hpp"
#include "tools/shared/commands.hpp"
#include "tools/shared/network_options.hpp"
#include "tools/study/output_folder.hpp"
#include "tools/study/run_script.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using latency::kNames;
using latency::kTitles;
using latency::LatencyOptions;
using Json = nlohmann::ordered_json;

/// Of three periods, and over and over: each way comes as often after each of the others.
constexpr std::array<std::size_t, 12> kOrder{0, 1, 2, 3, 0, 2, 1, 3, 2, 0, 3, 1};

std::vector<std::string> run_command(const LatencyOptions& o) {
  std::vector<std::string> command{sibling_program("palpate"),      "run", o.scene, "--processes", "3", "--domain",
                                   std::to_string(o.network.domain)};
  if (!o.network.keys.empty()) command.insert(command.end(), {"--keys", o.network.keys});
  return command;
}

struct Result {
  std::array<latency::RoundTripReport, kNames.size()> trips;
  HopTimes hops;
  bool observed = false;
};

/// The ways take turns within each period, so that a change of the host's load meets all of them, and in such an order
/// that none has the better of what went before: that leaves threads awake and caches warm, or cores busy.
Result measure(const LatencyOptions& o) {
  const auto other = latency::answerer_here(o);
  const auto ways = latency::open_ways({0, 1, 2, 3}, o);

  const auto bus = make_dds_bus(o.network);
  std::optional<latency::HopObserver> observer;
  std::optional<ChildProcess> simulation;
  if (o.attach || !o.scene.empty()) observer.emplace(*bus);
  if (!o.scene.empty() && !o.attach) simulation.emplace("run", run_command(o));
  if (observer) {
    for (const std::int64_t limit = now_ns() + 30 * kNsPerS;
         observer->times().force().count() < 100 && !shutdown_requested();) {
      observer->take();
      if (simulation && !simulation->running())
        throw std::runtime_error(fmt::format("latency: {} did not run", o.scene));
      if (now_ns() > limit)
        throw std::runtime_error(fmt::format("latency: no haptic node runs in domain {}", o.network.domain));
      sleep_until_ns(now_ns() + 5'000'000);
    }
    observer.emplace(*bus);
  }
  if (shutdown_requested()) throw Interrupted(latency::kStopped);

  PeriodicTimer timer(static_cast<double>(kNames.size()) * o.rate, 0);
  const auto warm_up = static_cast<std::uint64_t>(kNames.size() * o.rate * latency::kWarmUpSeconds),
             end = warm_up + static_cast<std::uint64_t>(kNames.size() * o.rate * o.seconds);
  bool begun = false;
  for (std::uint64_t i = timer.wait(); i < end && !shutdown_requested(); i = timer.wait()) {
    if (i >= warm_up && !begun) {
      for (auto& way : ways) way->begin();
      begun = true;
    }
    ways[kOrder[i % kOrder.size()]]->send();
    if (observer && i % 16 == 0) observer->take();
  }
  if (!begun) throw Interrupted(latency::kStopped);
  Result result;
  for (std::size_t i = 0; i < ways.size(); ++i) result.trips[i] = ways[i]->finish();
  if (observer) result.hops = observer->times();
  result.observed = observer.has_value();
  return result;
}

/// Bins with samples: lowest value [us] and count.
Json bins_of(const Histogram& h) {
  Json bins = Json::array();
  for (std::size_t b = 0; b < Histogram::kBins; ++b)
    if (h.in_bin(b) > 0) bins.push_back({1e-3 * static_cast<double>(Histogram::bin_start(b)), h.in_bin(b)});
  return bins;
}

Json json_of(const LatencyOptions& o, const Result& r) {
  Json json;
  for (std::size_t i = 0; i < kNames.size(); ++i) json[std::string(kNames[i]) + "_us"] = json_of(r.trips[i].time);
  for (const std::string way : {"bare_dds", "bare_dds_listener"})
    json["ratio_to_" + way] =
        json["round_trip_us"].is_null() || json[way + "_us"].is_null()
            ? Json(nullptr)
            : Json(json["round_trip_us"]["p50"].get<double>() / json[way + "_us"]["p50"].get<double>());
  json["hops_us"] = r.observed ? json_of(r.hops) : Json(nullptr);
  json["tissue_s"] = json_of(r.hops.tissue());
  json["sent"] = r.trips[0].sent;
  json["lost"] = r.trips[0].lost;
  json["reordered"] = r.trips[0].reordered;
  json["jitter_us"] = 1e-3 * r.trips[0].jitter_ns;
  json["keys"] = !o.network.keys.empty();
  json["rate_hz"] = o.rate;
  json["seconds"] = o.seconds;
  for (std::size_t i = 0; i < kNames.size(); ++i)
    json["ways"][kNames[i]] = {{"sent", r.trips[i].sent},
                               {"lost", r.trips[i].lost},
                               {"reordered", r.trips[i].reordered},
                               {"repeated", r.trips[i].repeated},
                               {"jitter_us", 1e-3 * r.trips[i].jitter_ns},
                               {"histogram_us", bins_of(r.trips[i].time)}};
  if (r.observed)
    json["hop_histograms_us"] = {{"tool_to_force", bins_of(r.hops.force())},
                                 {"tool_to_surface", bins_of(r.hops.surface())},
                                 {"tool_to_picture", bins_of(r.hops.picture())}};
  return json;
}

void print_row(const std::string& name, const Histogram& h, const std::string& rest = "") {
  if (h.count() == 0) {
    fmt::print("{:18} nothing came\n", name);
    return;
  }
  const Percentiles p = percentiles_us(h);
  fmt::print("{:18} {:10.1f} {:10.1f} {:10.1f} {:10.1f} {:10.1f}{}\n", name, p.p50, p.p90, p.p99, p.p999, p.max, rest);
}

void print_text(const Result& r) {
  fmt::print("{:18} {:>10} {:>10} {:>10} {:>10} {:>10} {:>9} {:>7} {:>10} {:>10}\n", "there and back [us]", "p50",
             "p90", "p99", "p99.9", "max", "sent", "lost", "reordered", "jitter");
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const auto& t = r.trips[i];
    print_row(kTitles[i], t.time,
              fmt::format(" {:9} {:7} {:10} {:10.1f}", t.sent, t.lost, t.reordered, 1e-3 * t.jitter_ns));
  }
  const auto median = [&](int way) { return static_cast<double>(r.trips[way].time.percentile(0.5)); };
  if (r.trips[0].time.count() > 0 && r.trips[1].time.count() > 0 && r.trips[2].time.count() > 0)
    fmt::print("the bus takes {:.2f} times as long as bare DDS, and {:.2f} times as long by listener (medians)\n",
               median(0) / median(1), median(0) / median(2));
  if (!r.observed) return;
  fmt::print("\none way [us]\n");
  print_row("tool to force", r.hops.force());
  print_row("tool to surface", r.hops.surface());
  print_row("tool to picture", r.hops.picture());
  fmt::print("{}", ahead_text(r.hops));
  fmt::print("{}", text_of(r.hops.tissue()));
  if (r.hops.uncertainty_ns() > 0)
    fmt::print("the nodes' clocks are known to {:.1f} us\n", 1e-3 * static_cast<double>(r.hops.uncertainty_ns()));
}

/// Median, least and most of the turns.
struct Spread {
  double median = 0, least = 0, most = 0;
};
Spread spread_of(std::vector<double> values) {
  std::ranges::sort(values);
  return {values[values.size() / 2], values.front(), values.back()};
}

void print_turns(const LatencyOptions& o, const latency::DdsperfTurns& turns) {
  const std::array columns{&turns.bus, &turns.listener, &turns.ddsperf};
  std::vector<double> ratios;
  for (std::size_t i = 0; i < turns.bus.size(); ++i) ratios.push_back(turns.bus[i] / turns.ddsperf[i]);
  const Spread ratio = spread_of(ratios);
  if (o.json) {
    constexpr std::array kKeys{"round_trip_us", "bare_dds_listener_us", "ddsperf_us"};
    Json json;
    for (std::size_t i = 0; i < columns.size(); ++i) json[kKeys[i]] = *columns[i];
    json["ratio_to_ddsperf"] = ratio.median;
    json["rate_hz"] = o.rate;
    json["seconds"] = o.seconds;
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{:22} {:>10} {:>10} {:>10}\n", "there and back [us]", "median", "least", "most");
  constexpr std::array kRows{"palpate's bus", "bare DDS by listener", "ddsperf by listener"};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Spread s = spread_of(*columns[i]);
    fmt::print("{:22} {:10.1f} {:10.1f} {:10.1f}\n", kRows[i], s.median, s.least, s.most);
  }
  fmt::print("the bus takes {:.2f} times as long as ddsperf (median of {} turns, {:.2f} to {:.2f})\n", ratio.median,
             o.ddsperf_turns, ratio.least, ratio.most);
}

/// Figures as a file has them.
constexpr const char* kFile = "latency.json";
std::string beginning_of_file() {
  return fmt::format("{{\n  \"{}_us\":", kNames[0]);
}

void run(LatencyOptions& o) {
  if (o.answer) return latency::answer(o);
  if (!o.scene.empty()) {
    const Scene scene = load_scene(o.scene);
    if (scene.network.security && o.network.keys.empty()) o.network.keys = scene.network.security->keys;
  }
  if (!o.network.interface.empty() && o.network.peers.empty())
    throw std::runtime_error("latency: with --interface, name the other host by --peer");
  if (o.ddsperf_turns > 0 &&
      (!o.scene.empty() || o.attach || !o.out.empty() || !o.network.peers.empty() || !o.network.keys.empty()))
    throw std::runtime_error("latency: --ddsperf is between two processes here, without a scene, --keys or --output");
  if (!o.out.empty()) prepare_folder(o.out, {kFile, beginning_of_file()}, {"latency.png"});
  catch_shutdown_signals();
  if (o.ddsperf_turns > 0) return print_turns(o, latency::beside_ddsperf(o));
  const Result result = measure(o);
  const Json json = json_of(o, result);
  if (o.json)
    fmt::print("{}\n", json.dump(2));
  else
    print_text(result);
  if (o.out.empty()) return;
  const auto file = std::filesystem::path(o.out) / kFile;
  std::ofstream stream(file);
  stream << json.dump(2) << "\n";
  if (!stream.flush()) throw std::runtime_error(fmt::format("{}: cannot write", file.string()));
  const std::string missing = run_script("latency_plot.py", o.out);
  fmt::print(stderr, "{}\n", missing.empty() ? (std::filesystem::path(o.out) / "latency.png").string() : missing);
}

}  // namespace

void add_latency_command(cli::Command& app) {
  auto o = std::make_shared<LatencyOptions>();
  cli::Command command = app.add_command(
      "latency",
      "Round trips to another process or host, beside bare DDS and bare UDP, and one-way times of a simulation");
  command.add_option("SCENE", o->scene, "Run this scene meanwhile and measure its hops up to the picture");
  command.add_flag("--attach", o->attach, "Measure the hops of a simulation that runs already");
  command.add_flag("--answer", o->answer, "Be the other side: send back what comes, until Ctrl-C");
  command.add_option("--rate", o->rate, "Messages a second over each way [Hz]").between(1.0, 5000.0).show_default();
  command.add_option("--seconds", o->seconds, "How long").positive().show_default();
  command
      .add_option("--ddsperf", o->ddsperf_turns,
                  "Instead, so many turns of the bus and of the vendor's ddsperf, each alone for --seconds, here")
      .between(1, 1000);
  command.add_option("--udp-port", o->port, "Port of the bare UDP messages").between(1024, 65535).show_default();
  command.add_flag("--json", o->json, "Print JSON");
  command.add_option("-o,--output", o->out, "Folder for latency.json and its plot, which take no other file's place");
  add_network_options(command, o->network, "latency");
  command.examples({"palpate latency scenes/liver.toml --seconds 10 -o out/latency", "palpate latency --answer",
                    "palpate latency --ddsperf 10 --seconds 4"});
  command.does([o] { run(*o); });
}

}  // namespace palpate
