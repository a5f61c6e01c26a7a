#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "common/bus/codec.hpp"

/// What stands in a topic log, inside the events of an LCM event log. docs/logs.md describes it for other
/// readers.
namespace palpate {

/// First event of a log.
struct LogHeader {
  std::string scene_hash;
  std::string
      scene;  ///< resolved scene as TOML; a recorder leaves it and what belongs to it empty, see LogReader::header()
  std::string schema;     ///< schema_text() of the program that wrote the log
  std::string version;    ///< software version of the recorder
  std::string code_path;  ///< of the haptic step: vector width and libraries; empty as above
  std::string host;
  std::int64_t start_wall_ns = 0;       ///< since 1970
  std::int64_t start_monotonic_ns = 0;  ///< the same moment on CLOCK_MONOTONIC of the recorder's host
  friend bool operator==(const LogHeader&, const LogHeader&) = default;
};

/// A file that the scene names, behind the event of the scene.
struct LogFile {
  std::string path;        ///< as the resolved scene has it
  std::string hash;        ///< XXH3, 128 bits, as 32 hexadecimal digits
  std::uint64_t size = 0;  ///< [bytes]
  Bytes content;           ///< empty if it is too large for a log
};

/// That a log from here on goes without what follows from the rest, see Thinning.
struct LogThinned {
  std::uint64_t steps = 0;  ///< from one kept outcome of a step to the next
};

/// Last event of a log whose recorder ended in order.
struct LogFooter {
  std::int64_t stop_monotonic_ns = 0;
  std::uint64_t written = 0;  ///< events before this one
  std::uint64_t lost = 0;     ///< messages that were received but not written
  std::string error;          ///< last reason for that, empty if none
};

inline constexpr const char* kHeaderChannel = "palpate/log_header";
inline constexpr const char* kFileChannel = "palpate/log_file";
inline constexpr const char* kThinnedChannel = "palpate/log_thinned";
inline constexpr const char* kFooterChannel = "palpate/log_footer";

/// The encoding of every message, one line each, then "topic NAME MESSAGE" lines.
std::string schema_text();

/// True if the two texts describe the same messages, in whatever order.
bool same_schema(const std::string& a, const std::string& b);

/// Whether a log may hold it as a time [ns]: differences of such, and their sums, are times too.
constexpr bool is_log_time(std::int64_t ns) {
  return ns >= 0 && ns <= std::numeric_limits<std::int64_t>::max() / 3;
}

/// Envelope of each event's data: "PLPT", u16 version, u16 0, u32 CRC-32 of channel name, receive time and
/// payload, i64 receive time, payload.
namespace envelope {
inline constexpr std::size_t kSize = 20;
inline constexpr std::uint16_t kVersion = 1;

/// Receive time [ns] is CLOCK_MONOTONIC of the recorder's host.
Bytes wrap(const std::string& channel, std::int64_t receive_ns, std::span<const std::uint8_t> payload);

/// The payload inside `data`, and its time. False if it is not such an envelope, is damaged, or has no possible time.
bool unwrap(const std::string& channel, std::span<const std::uint8_t> data, std::int64_t& receive_ns,
            std::span<const std::uint8_t>& payload);
}  // namespace envelope

}  // namespace palpate
