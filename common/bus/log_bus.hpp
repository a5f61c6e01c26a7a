#pragma once
#include <cstdint>
#include <memory>

#include "common/bus/bus.hpp"
#include "common/bus/log_writer.hpp"

namespace palpate {

/// The time of what is written next, in a log whose messages come from no clock.
struct LogClock {
  std::int64_t start_ns = 0;  ///< when time 0 of the messages is, on CLOCK_MONOTONIC of this host
  std::int64_t now_ns = 0;    ///< since then
};

/// A bus that writes a topic log: what its writers get stands in the log at the clock's time, their sense times moved
/// to it too. Nothing can be read from it. The log and the clock live at least as long.
std::unique_ptr<Bus> make_log_bus(LogWriter& log, const LogClock& clock);

}  // namespace palpate
