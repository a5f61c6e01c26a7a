#include "common/realtime/periodic.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <stdexcept>

#include "common/realtime/clock.hpp"

namespace palpate {
namespace {

TEST(PeriodicTimer, TicksLieOnAGridOfItsRate) {
  PeriodicTimer timer(500);
  timer.start();
  const std::int64_t start = timer.tick_time_ns();
  std::uint64_t tick = 0;
  for (int i = 0; i < 100; ++i) {
    tick = timer.wait();
    ASSERT_EQ(timer.tick_time_ns(), start + static_cast<std::int64_t>(tick) * timer.period_ns());
    ASSERT_GE(now_ns(), timer.tick_time_ns());
  }
  EXPECT_EQ(timer.statistics().ticks, 100u);
  EXPECT_EQ(timer.statistics().ticks + timer.statistics().skipped, tick);
  // The machine may be busy: the median alone is asserted.
  EXPECT_LT(timer.statistics().wake.percentile(0.5), 1'000'000);
  EXPECT_NEAR(static_cast<double>(timer.statistics().period.percentile(0.5)), 2e6, 0.5e6);
}

// A process that stands in its sleep, and is let go on in the midst of the fourth period.
TEST(PeriodicTimer, WhoWakesTooLateBeginsWithTheTickInWhichThatIs) {
  PeriodicTimer timer(1, 0);
  timer.start();
  const std::int64_t start = timer.tick_time_ns();
  const pid_t other = fork();
  if (other == 0) {
    sleep_until_ns(start + kNsPerS / 20);
    kill(getppid(), SIGSTOP);
    sleep_until_ns(start + 7 * kNsPerS / 2);
    kill(getppid(), SIGCONT);
    _exit(0);
  }
  ASSERT_GT(other, 0);
  const std::uint64_t tick = timer.wait();
  EXPECT_GE(tick, 3u);
  EXPECT_EQ(timer.statistics().skipped, tick - 1);
  EXPECT_LT(now_ns() - timer.tick_time_ns(), timer.period_ns());
  waitpid(other, nullptr, 0);
}

TEST(PeriodicTimer, MissedTicksAreSkippedAndNotMadeUpFor) {
  PeriodicTimer timer(1000);
  timer.start();
  ASSERT_GE(timer.wait(), 1u);
  const std::uint64_t before = timer.statistics().skipped;
  sleep_until_ns(timer.tick_time_ns() + 20'500'000);
  const std::uint64_t late = timer.wait();
  EXPECT_GE(late, 21u);
  EXPECT_GE(timer.statistics().skipped - before, 19u);
  EXPECT_EQ(timer.statistics().slack.min(), 0);
  const std::int64_t second = timer.tick_time_ns();
  timer.wait();
  EXPECT_GE(timer.tick_time_ns() - second, timer.period_ns());
  EXPECT_GE(now_ns(), timer.tick_time_ns());
}

TEST(PeriodicTimer, NonsenseRatesAreRefused) {
  EXPECT_THROW(PeriodicTimer(0), std::runtime_error);
  EXPECT_THROW(PeriodicTimer(-1), std::runtime_error);
  EXPECT_THROW(PeriodicTimer(std::nan("")), std::runtime_error);
  EXPECT_THROW(PeriodicTimer(1e9), std::runtime_error);
}

}  // namespace
}  // namespace palpate
