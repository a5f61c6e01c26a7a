#pragma once
#include <time.h>

#include <cstdint>

namespace palpate {

inline constexpr std::int64_t kNsPerS = 1'000'000'000;

/// CLOCK_MONOTONIC [ns]: the clock of every message and every loop.
inline std::int64_t now_ns() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * kNsPerS + t.tv_nsec;
}

/// CLOCK_REALTIME [ns since 1970]: for log headers only, never for intervals.
inline std::int64_t wall_ns() {
  timespec t;
  clock_gettime(CLOCK_REALTIME, &t);
  return t.tv_sec * kNsPerS + t.tv_nsec;
}

/// Sleeps until a monotonic time; a signal ends the sleep early, a time in the past returns at once.
inline void sleep_until_ns(std::int64_t time) {
  const timespec t{time / kNsPerS, time % kNsPerS};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
}

}  // namespace palpate
