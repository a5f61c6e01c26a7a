#include "tests/realtime/host_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "common/realtime/clock.hpp"
#include "common/realtime/settings.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kMsNs = 1'000'000;

/// Takes the first core from everything else, as a host would. False without the right to do so.
bool take_first_core(std::int64_t for_ns) {
  bool granted = false;
  std::jthread thief([&] {
    granted = request_realtime({.priority = 99, .lock_memory = false, .core = 0}).scheduler;
    const std::int64_t until = now_ns() + for_ns;
    while (granted && now_ns() < until) continue;
  });
  thief.join();
  return granted;
}

TEST(HostWatch, KnowsWhenACoreStoodStillAndCountsNoTickOfThatTime) {
  const HostWatch host;
  std::this_thread::sleep_for(20ms);
  const std::int64_t begin = now_ns();
  if (!take_first_core(100 * kMsNs)) GTEST_SKIP() << "no real-time rights: no core can be taken";
  std::this_thread::sleep_for(100ms);
  const std::int64_t end = now_ns();
  const double still = host.stood_still(begin, end), all = 1e-9 * static_cast<double>(end - begin);
  EXPECT_GT(still, 0.095);
  EXPECT_LT(still, 0.95 * all) << "what ran is not taken for a pause";
  EXPECT_NEAR(host.rate_hz(100, begin, end), 100 / (all - still), 1e-6);
  EXPECT_NEAR(host.stood_still(begin, begin + 50 * kMsNs), 0.05, 0.01) << "a pause's part within the time asked for";
  EXPECT_EQ(host.rate_hz(1, begin + 20 * kMsNs, begin + 60 * kMsNs), 0) << "nothing but pause";
}

}  // namespace
}  // namespace palpate::testing
