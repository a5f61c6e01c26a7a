#pragma once
#include <chrono>
#include <cstddef>
#include <vector>

namespace palpate::study {

/// Seconds since `begin`.
inline double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// [bytes] that this process holds of what it asked the C library for.
std::size_t bytes_in_use();

/// Times of one piece of work.
struct StepTime {
  double median = 0, p99 = 0;  ///< [s]
};

StepTime summarise(std::vector<double> seconds);

/// Calls work(i) `warm_up` times, then `count` times on the clock [s]; i counts all calls.
template <class Work>
std::vector<double> time_steps(int warm_up, int count, Work&& work) {
  std::vector<double> seconds;
  seconds.reserve(count);
  for (int i = 0; i < warm_up + count; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    work(i);
    if (i >= warm_up) seconds.push_back(seconds_since(begin));
  }
  return seconds;
}

}  // namespace palpate::study
