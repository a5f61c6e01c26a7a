#include "tests/realtime/speed_watch.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "common/realtime/clock.hpp"
#include "common/realtime/settings.hpp"

namespace palpate::testing {
namespace {

constexpr int kBeforeOthers = 99;  // SCHED_FIFO
constexpr std::chrono::milliseconds kEach{1};
constexpr double kDue = 1.5e-3;  // [s] from one look to the next: what is beyond it stood still
constexpr int kWork = 2000;      // multiplications, each of what the last one gave: some 3 us

std::uint64_t work(std::uint64_t x) {
  for (int i = 0; i < kWork; ++i) x = x * 6364136223846793005U + 1442695040888963407U;
  return x;
}

double seconds(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

}  // namespace

SpeedWatch::SpeedWatch() : thread_([this](const std::stop_token& stop) { watch(stop); }) {}

SpeedWatch::~SpeedWatch() = default;

void SpeedWatch::watch(const std::stop_token& stop) {
  request_realtime({.priority = kBeforeOthers, .lock_memory = false});
  volatile std::uint64_t number = 1;  // that it is worked out
  for (std::int64_t last = now_ns(); !stop.stop_requested();) {
    std::this_thread::sleep_for(kEach);
    const std::int64_t begin = now_ns();
    number = work(number);
    const std::int64_t end = now_ns();
    const std::lock_guard lock(mutex_);
    looks_.push_back({seconds(end - last), seconds(end - begin)});
    last = end;
  }
}

double SpeedWatch::lost() const {
  const std::lock_guard lock(mutex_);
  if (looks_.empty()) return 0;
  const double fastest = std::ranges::min(looks_, {}, &Look::took).took;
  double sum = 0;
  for (const Look& l : looks_) {
    const double stood = std::max(l.passed - kDue, 0.0);
    sum += stood + (l.passed - stood) * (1 - fastest / l.took);
  }
  return sum;
}

}  // namespace palpate::testing
