#include "common/realtime/periodic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/realtime/clock.hpp"

namespace palpate {
namespace {
constexpr std::int64_t kMaxSpinNs = 150'000;
}

PeriodicTimer::PeriodicTimer(double rate_hz, std::int64_t spin_ns) {
  if (!(rate_hz > 0) || rate_hz > 1e5)
    throw std::runtime_error(fmt::format("a loop rate of {} Hz is outside 0..100000 Hz", rate_hz));
  period_ns_ = std::llround(1e9 / rate_hz);
  spin_ns_ = std::clamp<std::int64_t>(spin_ns, 0, std::min(kMaxSpinNs, period_ns_));
}

void PeriodicTimer::start() {
  tick_time_ns_ = woken_ns_ = now_ns();
  tick_ = 0;
}

std::uint64_t PeriodicTimer::wait() {
  if (woken_ns_ == 0) start();
  std::int64_t now = now_ns();
  std::int64_t next = tick_time_ns_ + period_ns_;
  statistics_.slack.record(next - now);

  const auto missed_by = [&] { return now > next ? (now - next) / period_ns_ : 0; };
  std::int64_t missed = missed_by();
  next += missed * period_ns_;
  while (next - now > spin_ns_) {  // a signal may end the sleep early
    sleep_until_ns(next - spin_ns_);
    now = now_ns();
  }
  while (now < next) now = now_ns();
  // Who is woken too late begins with the period in which that is.
  const std::int64_t slept = missed_by();
  missed += slept;
  next += slept * period_ns_;

  tick_ += static_cast<std::uint64_t>(missed) + 1;
  tick_time_ns_ = next;
  ++statistics_.ticks;
  statistics_.skipped += static_cast<std::uint64_t>(missed);
  statistics_.wake.record(now - next);
  statistics_.period.record(now - woken_ns_);
  woken_ns_ = now;
  return tick_;
}

}  // namespace palpate
