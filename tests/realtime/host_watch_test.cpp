#include "tests/realtime/host_watch.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <thread>

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

TEST(HostWatch, OfTheHostAloneCountsNothingThatOthersOfThisMachineTake) {
  const HostWatch host(HostWatch::By::host);
  std::this_thread::sleep_for(20ms);
  const std::int64_t begin = now_ns();
  if (!take_first_core(100 * kMsNs)) GTEST_SKIP() << "no real-time rights: no core can be taken";
  std::this_thread::sleep_for(20ms);
  EXPECT_LT(host.stood_still(begin, now_ns()), 0.05);
}

/// [s] for which a watch of the host alone has seen its process stand still until it is told to look.
double seen_until_told(int told, int ready) {
  const HostWatch host(HostWatch::By::host);
  std::this_thread::sleep_for(20ms);
  const std::int64_t begin = now_ns();
  std::byte any{};
  if (write(ready, &any, 1) != 1 || read(told, &any, 1) != 1) return -1;
  return host.stood_still(begin, now_ns());
}

// A process that is stopped waits for no core, as one does not whose whole machine stands still.
TEST(HostWatch, OfTheHostAloneCountsWhatStandsStillWithoutWaitingForACore) {
  std::array<int, 2> there{}, back{};
  ASSERT_EQ(pipe(there.data()) + pipe(back.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    const double seen = seen_until_told(there[0], back[1]);
    _exit(write(back[1], &seen, sizeof seen) == sizeof seen ? 0 : 1);
  }
  std::byte any{};
  double seen = 0;
  ASSERT_EQ(read(back[0], &any, 1), 1);
  kill(child, SIGSTOP);
  std::this_thread::sleep_for(100ms);
  kill(child, SIGCONT);
  std::this_thread::sleep_for(20ms);
  ASSERT_EQ(write(there[1], &any, 1), 1);
  ASSERT_EQ(read(back[0], &seen, sizeof seen), static_cast<ssize_t>(sizeof seen));
  EXPECT_EQ(waitpid(child, nullptr, 0), child);
  EXPECT_GT(seen, 0.095);
}

}  // namespace
}  // namespace palpate::testing
