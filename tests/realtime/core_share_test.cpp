#include "common/realtime/core_share.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// Of a core, over ten seconds: a loop whose works take so long, each begun at a time on a grid of 1 ms, or at once
/// where that is past.
double share_of(double work_ms) {
  CoreShare share(0.85);
  const auto work = static_cast<std::int64_t>(work_ms * kMs);
  std::int64_t now = 5, due = 5, worked = 0;
  while (now < 10'000 * kMs) {
    due += std::max<std::int64_t>((now - due) / kMs, 1) * kMs;
    const std::int64_t begin = std::max(now, due), end = begin + work;
    worked += work;
    now = end + share.rest(begin, end);
  }
  return static_cast<double>(worked) / static_cast<double>(now);
}

TEST(CoreShare, WorkThatFitsIsNotHeldUp) {
  EXPECT_NEAR(share_of(0.2), 0.2, 1e-3);
  EXPECT_NEAR(share_of(0.8), 0.8, 1e-3);
}

TEST(CoreShare, ALoopThatIsAlwaysLateLeavesItsShareOfEachSecond) {
  for (const double work_ms : {0.95, 1.0, 1.3, 7.0, 40.0}) {
    EXPECT_LT(share_of(work_ms), 0.855) << work_ms;
    EXPECT_GT(share_of(work_ms), 0.6) << work_ms;
  }
}

TEST(CoreShare, ASingleLongWorkNeedsARestThatGoesWithIt) {
  CoreShare share(0.5);
  EXPECT_EQ(share.rest(0, kMs), 0);
  const std::int64_t rest = share.rest(10 * kMs, 50 * kMs);
  EXPECT_NEAR(static_cast<double>(rest), 31e6, 1e6);  // 40 ms of work in 49 ms, half of which is its share
  EXPECT_EQ(share.rest(50 * kMs + rest, 51 * kMs + rest), 0);
  EXPECT_EQ(share.rest(100 * kMs, 5'000 * kMs), 40 * kMs) << "stopped by a debugger, say";
}

}  // namespace
}  // namespace palpate
