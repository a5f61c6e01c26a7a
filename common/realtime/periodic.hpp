#pragma once
#include <cstdint>

#include "common/realtime/histogram.hpp"

namespace palpate {

/// Figures of a fixed-rate loop since its start or the last reset.
struct PeriodStatistics {
  std::uint64_t ticks = 0;    ///< ticks that ran
  std::uint64_t skipped = 0;  ///< ticks that fell out because the loop was late by a whole period or more
  Histogram period;           ///< [ns] from start of tick to start of tick
  Histogram wake;             ///< [ns] by which a tick starts after its time
  Histogram slack;            ///< [ns] left of the period when wait() is called; 0 if overrun
};

/// Fixed-rate timer on a grid of absolute times: sleeps, then spins for the last bit, because waking up takes
/// longer than the jitter that a 1 kHz loop can bear. Missed ticks are skipped, not made up for. No
/// allocation.
class PeriodicTimer {
 public:
  /// spin_ns: how long before a tick it wakes to spin, at most 150 us; 0 sleeps only.
  /// Throws std::runtime_error unless 0 < rate_hz <= 100 kHz.
  explicit PeriodicTimer(double rate_hz, std::int64_t spin_ns = 100'000);

  /// Begins the grid now; the first wait() ends one period later. Called by the first wait() if not before.
  void start();
  /// Returns at the next tick: its number on the grid, which jumps over skipped ticks. Counts from 1.
  std::uint64_t wait();

  std::int64_t period_ns() const { return period_ns_; }
  std::int64_t tick_time_ns() const { return tick_time_ns_; }  ///< grid time of the current tick
  const PeriodStatistics& statistics() const { return statistics_; }
  void reset_statistics() { statistics_ = PeriodStatistics(); }

 private:
  std::int64_t period_ns_, spin_ns_;
  std::int64_t tick_time_ns_ = 0, woken_ns_ = 0;
  std::uint64_t tick_ = 0;
  PeriodStatistics statistics_;
};

}  // namespace palpate
