#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/latency/echo.hpp"
#include "tools/latency/round_trips.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate::latency {

struct LatencyOptions {
  BusSettings network;
  std::string scene, out;
  double rate = 1000;   ///< [Hz] messages over each way
  double seconds = 10;  ///< of sending, after the warm-up
  int port = 7390;      ///< of the UDP datagrams
  int ddsperf_turns = 0;
  bool answer = false, attach = false, json = false;
};

/// The ways there are, by their places in these lists.
constexpr std::array kNames{"round_trip", "bare_dds", "bare_dds_listener", "bare_udp"};
constexpr std::array kTitles{"palpate's bus", "bare Cyclone DDS", "  by listener", "bare UDP"};
constexpr std::size_t kBus = 0, kBareDds = 1, kListener = 2;

constexpr double kWarmUpSeconds = 0.3;
constexpr const char* kStopped = "latency: stopped before anything was measured";

/// Sends back whatever comes, over each way on a thread of its own, until told to stop.
void answer(const LatencyOptions& o);

/// The other side, on this machine, where no other host is named.
std::optional<ChildProcess> answerer_here(const LatencyOptions& o);

/// These ways, once each has brought something back. Throws std::runtime_error, which names the silent ones, where that
/// takes more than 10 s.
std::vector<std::unique_ptr<RoundTrips>> open_ways(const std::vector<std::size_t>& ways, const LatencyOptions& o);

}  // namespace palpate::latency
