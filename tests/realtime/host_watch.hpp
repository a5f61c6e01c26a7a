#pragma once
#include <cstdint>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace palpate::testing {

/// When this machine did not run: a virtual one's host has other things to do now and then, for up to a second, and no
/// loop's rate says anything then. On each core a thread before which nothing else comes wakes each millisecond; where
/// it is late, so would any loop have been. Without real-time rights it is late where others compute, too.
class HostWatch {
 public:
  /// What makes a core stand still: whatever keeps the thread from it, or less what it waits while the core runs others
  /// of this machine, as the kernel counts it.
  enum class By { any, host };

  explicit HostWatch(By by = By::any);  ///< on all cores that this process may run on
  HostWatch(By by, const std::vector<int>& cores);
  ~HostWatch();

  /// [s] of this time (of the monotonic clock) in which one of the cores or another stood still.
  double stood_still(std::int64_t from_ns, std::int64_t to_ns) const;
  /// [s] so far that the host gave to others while a core had work, of all cores together, as the kernel counts it in
  /// hundredths. Pauses too short to be seen are in it.
  static double stolen();
  /// [Hz] of so many ticks in this time, without what stood still. 0 where nothing else is left.
  double rate_hz(double ticks, std::int64_t from_ns, std::int64_t to_ns) const;

 private:
  struct Pause {
    std::int64_t from_ns, to_ns;
  };
  void watch(const std::stop_token& stop, int core, By by);

  mutable std::mutex mutex_;
  std::vector<Pause> pauses_;  ///< as they ended
  std::vector<std::jthread> threads_;
};

}  // namespace palpate::testing
