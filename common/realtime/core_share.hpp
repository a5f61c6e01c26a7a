#pragma once
#include <cstdint>

namespace palpate {

/// Keeps a loop to a share of a core. The kernel stops all realtime threads of a core for the rest of a second once
/// they have had 95 % of it (sched_rt_runtime_us): a loop that never rests takes those of a higher priority with it.
class CoreShare {
 public:
  /// 0 < share < 1.
  explicit CoreShare(double share) : share_(share) {}

  /// [ns] to rest after work from `begin` to `end`: none while what the loop has rested by itself suffices within 2 ms.
  std::int64_t rest(std::int64_t begin, std::int64_t end);

 private:
  double share_;
  double over_ = 0;  ///< [ns] of work beyond the share
  std::int64_t last_end_ = 0;
};

}  // namespace palpate
