#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/bus/log_reader.hpp"
#include "common/realtime/histogram.hpp"
#include "tools/latency/hop_times.hpp"

namespace palpate {

/// What a log says about one topic.
struct TopicSummary {
  std::uint64_t samples = 0;
  std::uint64_t streams = 0;               ///< keys and runs
  std::uint64_t gaps = 0;                  ///< places where sequence numbers are missing
  std::uint64_t missing = 0;               ///< sequence numbers that are missing
  std::uint64_t repeated = 0;              ///< sequence numbers that came again or late
  std::uint64_t invalid = 0;               ///< events that do not decode to a valid message
  std::int64_t first_ns = 0, last_ns = 0;  ///< receive times
  std::uint64_t ahead = 0;                 ///< whose sense lies after their reception: they count as 0 below
  Histogram to_publish;                    ///< [ns] sense to publication, for messages that carry both
  Histogram to_receive;  ///< [ns] sense to reception by the recorder; honest on the recorder's host alone
  double rate_hz() const;
};

struct LogSummary {
  LogHeader header;
  bool has_header = false;
  std::string title;      ///< of the scene; empty if it has none
  std::string code_path;  ///< of the haptic step; empty if unknown
  double seconds = 0;     ///< from the first sample to the last
  std::uint64_t bytes = 0;
  std::uint64_t thinned_steps = 0;             ///< see LogReader::thinned_steps()
  std::uint64_t untold_steps = 0;              ///< of the haptic node, which never came to the bus
  std::string runs_at_once;                    ///< see RunsAtOnce; empty: there are none
  std::uint64_t unknown = 0;                   ///< events of topics that this program does not know
  std::map<std::string, TopicSummary> topics;  ///< those with samples
  HopTimes hops;
  std::vector<TaskRecord> tasks;  ///< the last one of each catheter and run, in order of appearance
  std::vector<LogFile> files;     ///< that go along, without contents
  std::vector<LogDamage> damage;
  std::string damage_text;
  std::optional<LogFooter> footer;  ///< absent if the recorder was killed or the end is lost
};

/// Reads a whole log. Throws std::runtime_error if it is no log.
LogSummary summarise_log(const std::filesystem::path& file);

}  // namespace palpate
