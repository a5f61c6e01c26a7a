#pragma once
#include <chrono>

#include "common/fem/progress.hpp"

namespace palpate {

/// Reports the time since the last lap.
class Stopwatch {
 public:
  explicit Stopwatch(const Progress& progress) : progress_(progress) {}

  void lap(std::string_view stage) {
    const auto now = std::chrono::steady_clock::now();
    if (progress_) progress_(stage, std::chrono::duration<double>(now - last_).count());
    last_ = now;
  }

 private:
  const Progress& progress_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace palpate
