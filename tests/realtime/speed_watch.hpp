#pragma once
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace palpate::testing {

/// What this machine's cores lose of their speed: a virtual one's host may clock them at a twelfth for some
/// milliseconds, time and again, and no tick is in time then. A thread before which nothing else comes does the same
/// little work in registers each millisecond; by how much longer that took than the fastest is what was lost.
class SpeedWatch {
 public:
  SpeedWatch();
  ~SpeedWatch();

  /// [s] of computing so far that a core lost, being slow or standing still.
  double lost() const;

 private:
  struct Look {
    double passed, took;  ///< [s] since the last one; for the work
  };
  void watch(const std::stop_token& stop);

  mutable std::mutex mutex_;
  std::vector<Look> looks_;
  std::jthread thread_;
};

}  // namespace palpate::testing
