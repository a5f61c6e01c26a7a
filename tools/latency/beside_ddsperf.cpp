#include "tools/latency/beside_ddsperf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <stdexcept>
#include <utility>

#include "common/realtime/clock.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/shutdown.hpp"

namespace palpate::latency {
namespace {

constexpr int kBytes = 160;  // a ToolState has 136, a ForceState 180

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + std::ssize(values) / 2);
  return values[values.size() / 2];
}

double median_alone(std::size_t way, const LatencyOptions& o) {
  const auto other = answerer_here(o);
  const auto ways = open_ways({way}, o);
  PeriodicTimer timer(o.rate, 0);
  const auto warm_up = static_cast<std::uint64_t>(o.rate * kWarmUpSeconds);
  const auto end = warm_up + static_cast<std::uint64_t>(o.rate * o.seconds);
  bool begun = false;
  for (std::uint64_t i = timer.wait(); i < end && !shutdown_requested(); i = timer.wait()) {
    if (i >= warm_up && !std::exchange(begun, true)) ways[0]->begin();
    ways[0]->send();
  }
  if (shutdown_requested()) throw Interrupted(kStopped);
  return 1e-3 * static_cast<double>(ways[0]->finish().time.percentile(0.5));
}

std::vector<std::string> command(const LatencyOptions& o, double seconds, std::vector<std::string> role) {
  role.insert(role.begin(), {"/usr/bin/env", "ddsperf", "-i", std::to_string(o.network.domain), "-D",
                             fmt::format("{:.0f}", std::ceil(seconds))});
  return role;
}

/// The median of its seconds' medians; it prints halves of round trips, once a second.
double median_of_ddsperf(const LatencyOptions& o) {
  ChildProcess pong("ddsperf", command(o, o.seconds + 3, {"pong"}));
  ChildProcess ping(
      "ddsperf", command(o, o.seconds + 1, {"ping", fmt::format("{:.0f}Hz", o.rate), "size", std::to_string(kBytes)}));
  static const std::regex kHalf(" mean .* 50% ([0-9.]+)us");
  std::vector<double> medians;
  const auto read = [&] {
    std::smatch found;
    for (const std::string& line : ping.take_lines())
      if (std::regex_search(line, found, kHalf)) medians.push_back(2 * std::stod(found[1]));
  };
  for (; ping.running() && !shutdown_requested(); sleep_until_ns(now_ns() + 20'000'000)) read();
  read();
  if (shutdown_requested()) throw Interrupted(kStopped);
  constexpr int kNotFound = 127;
  if (ping.status() == kNotFound)
    throw std::runtime_error("latency: ddsperf is not installed; `apt install cyclonedds-tools` brings it");
  if (medians.empty()) throw std::runtime_error("latency: ddsperf printed no round trips");
  return median(medians);
}

}  // namespace

DdsperfTurns beside_ddsperf(const LatencyOptions& o) {
  DdsperfTurns turns;
  for (int i = 0; i < o.ddsperf_turns; ++i) {
    turns.bus.push_back(median_alone(kBus, o));
    turns.listener.push_back(median_alone(kListener, o));
    turns.ddsperf.push_back(median_of_ddsperf(o));
  }
  return turns;
}

}  // namespace palpate::latency
