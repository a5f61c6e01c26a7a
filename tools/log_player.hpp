#pragma once
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/realtime/histogram.hpp"

namespace palpate {

struct PlaySettings {
  double speed = 1;                          ///< 2 plays twice as fast
  std::vector<std::string> topics;           ///< names to play; empty: all
  std::chrono::milliseconds patience{1000};  ///< how long to wait at first for every topic to have a reader
};

struct PlayReport {
  std::uint64_t played = 0;   ///< samples sent
  std::uint64_t skipped = 0;  ///< events left out: other topics, invalid, refused by the bus
  std::uint64_t leaps = 0;    ///< of the receive times, by more than an hour: they count as no time
  double seconds = 0;         ///< of the log, from its first sample
  Histogram pace;             ///< [ns] from a sample's recorded time until the bus had it
  bool complete = false;      ///< the end of the log was reached
  std::string damage;         ///< sentence on damaged places, empty if none
};

/// Sends the samples of a log to a bus at their recorded distances in time. Times inside the messages are
/// moved by as much as the message itself, so that latencies come out as recorded. `progress` is called about
/// four times a second with the time [s] in the log; playing ends when it returns false. Throws
/// std::runtime_error if the file is no log or a topic in `settings` does not exist.
PlayReport play_log(const std::filesystem::path& file, Bus& bus, const PlaySettings& settings,
                    const std::function<bool(double)>& progress);

}  // namespace palpate
