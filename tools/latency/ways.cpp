#include "tools/latency/ways.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/realtime/clock.hpp"
#include "common/realtime/shutdown.hpp"

namespace palpate::latency {
namespace {

using namespace std::chrono_literals;

std::unique_ptr<Echo> open(std::size_t way, const LatencyOptions& o, Side side) {
  if (way == kBus) return bus_echo(o.network, side);
  if (way == kBareDds) return dds_echo(o.network, side, Wake::waitset);
  if (way == kListener) return dds_echo(o.network, side, Wake::listener);
  return udp_echo(o.network.peers.empty() ? "127.0.0.1" : o.network.peers.front(), o.port, side);
}

std::vector<std::string> with_network(std::vector<std::string> command, const BusSettings& network) {
  command.insert(command.end(), {"--domain", std::to_string(network.domain)});
  if (!network.interface.empty()) command.insert(command.end(), {"--interface", network.interface});
  for (const std::string& peer : network.peers) command.insert(command.end(), {"--peer", peer});
  if (!network.keys.empty()) command.insert(command.end(), {"--keys", network.keys});
  return command;
}

}  // namespace

void answer(const LatencyOptions& o) {
  std::array<std::unique_ptr<Echo>, kNames.size()> ways;
  for (std::size_t way = 0; way < ways.size(); ++way) ways[way] = open(way, o, Side::answers);
  catch_shutdown_signals();
  std::vector<std::jthread> threads;
  for (auto& way : ways)
    if (!way->listen([&way](std::uint64_t seq) { way->send(seq); }))
      threads.emplace_back([&way](const std::stop_token& stop) {
        while (!stop.stop_requested())
          if (const std::uint64_t seq = way->receive(20ms)) way->send(seq);
      });
  if (!o.json) fmt::print("answering in domain {} and on UDP port {}\n", o.network.domain, o.port);
  std::fflush(stdout);
  while (!shutdown_requested()) sleep_until_ns(now_ns() + 20'000'000);
}

std::optional<ChildProcess> answerer_here(const LatencyOptions& o) {
  if (!o.network.peers.empty()) return std::nullopt;
  return ChildProcess("latency --answer", with_network({sibling_program("palpate"), "latency", "--answer", "--json",
                                                        "--udp-port", std::to_string(o.port)},
                                                       o.network));
}

std::vector<std::unique_ptr<RoundTrips>> open_ways(const std::vector<std::size_t>& ways, const LatencyOptions& o) {
  std::vector<std::unique_ptr<RoundTrips>> all;
  for (const std::size_t way : ways) all.push_back(std::make_unique<RoundTrips>(open(way, o, Side::asks)));
  const std::int64_t limit = now_ns() + 10 * kNsPerS;
  const auto silent = [&]() -> std::string {
    std::string text;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i]->back() == 0) text += (text.empty() ? "" : ", ") + std::string(kNames[ways[i]]);
    return text;
  };
  while (!silent().empty() && !shutdown_requested()) {
    if (now_ns() > limit)
      throw std::runtime_error(
          fmt::format("latency: no answer over {} within 10 s; `palpate latency --answer` has to run on the other "
                      "host, in domain {}, and "
                      "UDP port {} has to be open there",
                      silent(), o.network.domain, o.port));
    for (auto& way : all)
      if (way->back() == 0) way->send();
    sleep_until_ns(now_ns() + 20'000'000);
  }
  return all;
}

}  // namespace palpate::latency
