#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>

#include "common/realtime/clock.hpp"

namespace palpate {

/// The time in a log since its first event. Times more than an hour apart are not true: between them none passes.
class LogTime {
 public:
  /// [ns] of an event that came after the last one that was asked for.
  std::int64_t since_start(std::int64_t receive_ns) {
    if (!std::exchange(begun_, true)) last_ = receive_ns;
    std::int64_t passed = 0;
    const bool far = __builtin_sub_overflow(receive_ns, std::exchange(last_, receive_ns), &passed) ||
                     passed > kLongestSilence || passed < -kLongestSilence;
    leaps_ += far;
    if (!far) since_start_ += passed;
    return std::max<std::int64_t>(since_start_, 0);
  }
  std::uint64_t leaps() const { return leaps_; }

 private:
  static constexpr std::int64_t kLongestSilence = 3600 * kNsPerS;

  bool begun_ = false;
  std::int64_t last_ = 0, since_start_ = 0;
  std::uint64_t leaps_ = 0;
};

}  // namespace palpate
