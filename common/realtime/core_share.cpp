#include "common/realtime/core_share.hpp"

#include <algorithm>

namespace palpate {
namespace {
constexpr double kBurst = 2e6;    // [ns] beyond the share that need no rest
constexpr double kLargest = 2e7;  // [ns] that are made good: who has been stopped for long need not rest for long
}  // namespace

std::int64_t CoreShare::rest(std::int64_t begin, std::int64_t end) {
  if (last_end_ == 0) last_end_ = begin;
  const auto worked = static_cast<double>(end - begin), passed = static_cast<double>(end - last_end_);
  last_end_ = end;
  over_ = std::clamp(over_ + worked - share_ * passed, 0.0, kLargest);
  return over_ > kBurst ? static_cast<std::int64_t>(over_ / share_) : 0;
}

}  // namespace palpate
