#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "common/bus/log_reader.hpp"

namespace palpate {

/// Tells of two haptic nodes whose steps stand in one log by turns, where one run is to have ended before the next.
class RunsAtOnce {
 public:
  void add(const LogEvent& event);  ///< in the log's order
  /// "it holds two runs at once, 1f and 2a, from 0.8 s to 2.1 s"; empty where each run ended before the next began.
  std::string text() const;

 private:
  std::map<std::uint64_t, std::int64_t> begin_ns_;  ///< by run
  std::int64_t log_begin_ns_ = 0;
  std::uint64_t current_ = 0;
  struct {
    std::uint64_t first = 0, second = 0;  ///< runs
    std::int64_t begin_ns = 0, end_ns = 0;
  } both_;
};

/// What RunsAtOnce tells of a whole log.
std::string runs_at_once(const std::filesystem::path& log);

}  // namespace palpate
