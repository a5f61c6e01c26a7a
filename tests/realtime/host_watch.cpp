#include "tests/realtime/host_watch.hpp"

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <string>
#include <utility>

#include "common/realtime/clock.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/settings.hpp"

namespace palpate::testing {
namespace {

constexpr int kBeforeAll = 99;                // SCHED_FIFO
constexpr double kRateHz = 1000;              // of waking
constexpr std::int64_t kPauseNs = 2'000'000;  // later than this is the host's doing
constexpr std::int64_t kNoSpin = 0;

std::vector<int> allowed_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  sched_getaffinity(0, sizeof set, &set);
  std::vector<int> cores;
  for (int core = 0; core < CPU_SETSIZE; ++core)
    if (CPU_ISSET(core, &set)) cores.push_back(core);
  return cores;
}

/// How long a thread was ready to run while its core ran others.
class RunDelay {
 public:
  RunDelay() : file_(open("/proc/thread-self/schedstat", O_RDONLY | O_CLOEXEC)) {}
  ~RunDelay() {
    if (file_ >= 0) close(file_);
  }
  RunDelay(const RunDelay&) = delete;

  /// [ns] since the last call; 0 where the kernel does not count it.
  std::int64_t take() {
    std::array<char, 100> text{};  // "RUN DELAY SLICES"
    const ssize_t size = pread(file_, text.data(), text.size() - 1, 0);
    const char* const space = std::find(text.data(), text.data() + std::max<ssize_t>(size, 0), ' ');
    std::int64_t all = all_;
    std::from_chars(space + 1, text.data() + text.size(), all);
    return all - std::exchange(all_, all);
  }

 private:
  int file_;
  std::int64_t all_ = 0;
};

}  // namespace

HostWatch::HostWatch(By by) : HostWatch(by, allowed_cores()) {}

HostWatch::HostWatch(By by, const std::vector<int>& cores) {
  for (const int core : cores)
    threads_.emplace_back([this, core, by](const std::stop_token& stop) { watch(stop, core, by); });
}

HostWatch::~HostWatch() {
  threads_.clear();
}

void HostWatch::watch(const std::stop_token& stop, int core, By by) {
  request_realtime({.priority = kBeforeAll, .lock_memory = false, .core = core});
  PeriodicTimer timer(kRateHz, kNoSpin);
  timer.start();
  RunDelay delay;
  delay.take();
  std::int64_t last_ns = now_ns();
  while (!stop.stop_requested()) {
    timer.wait();
    const std::int64_t now = now_ns(), until = by == By::host ? now - delay.take() : now;
    if (until - last_ns > timer.period_ns() + kPauseNs) {
      const std::lock_guard lock(mutex_);
      pauses_.push_back({last_ns, until});
    }
    last_ns = now;
  }
}

double HostWatch::stood_still(std::int64_t from_ns, std::int64_t to_ns) const {
  std::vector<Pause> pauses;
  {
    const std::lock_guard lock(mutex_);
    pauses = pauses_;
  }
  std::ranges::sort(pauses, {}, &Pause::from_ns);
  std::int64_t sum = 0, counted_to = from_ns;
  for (const Pause& p : pauses) {
    const std::int64_t from = std::max(p.from_ns, counted_to), to = std::min(p.to_ns, to_ns);
    if (to <= from) continue;
    sum += to - from;
    counted_to = to;
  }
  return 1e-9 * static_cast<double>(sum);
}

double HostWatch::stolen() {
  std::ifstream file("/proc/stat");
  std::string cpu;
  double user = 0, nice = 0, system = 0, idle = 0, io = 0, irq = 0, soft_irq = 0, stolen = 0;
  file >> cpu >> user >> nice >> system >> idle >> io >> irq >> soft_irq >> stolen;
  return stolen / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double HostWatch::rate_hz(double ticks, std::int64_t from_ns, std::int64_t to_ns) const {
  const double seconds = 1e-9 * static_cast<double>(to_ns - from_ns) - stood_still(from_ns, to_ns);
  return seconds > 0 ? ticks / seconds : 0;
}

}  // namespace palpate::testing
