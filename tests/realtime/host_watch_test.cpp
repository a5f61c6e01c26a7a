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

/// Takes the first core from everything else. False without the right to do so.
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

/// What a watch says of its process's time, in which that stands still for a while, as all of a machine does.
struct Watched {
  double still = 0, all = 0;  ///< [s]
  double first_half = 0;      ///< [s] of the first 50 ms
  double rate = 0;            ///< [Hz] of 100 ticks in all of it
  double within = -1;         ///< [Hz] in the midst of what stood still
};

Watched watch(int begun, int stood) {
  const HostWatch host;
  std::this_thread::sleep_for(20ms);
  const std::int64_t begin = now_ns();
  std::byte any{};
  Watched seen;
  if (write(begun, &any, 1) != 1 || read(stood, &any, 1) != 1) return seen;
  const std::int64_t end = now_ns();
  seen.still = host.stood_still(begin, end);
  seen.all = 1e-9 * static_cast<double>(end - begin);
  seen.first_half = host.stood_still(begin, begin + 50 * kMsNs);
  seen.rate = host.rate_hz(100, begin, end);
  seen.within = host.rate_hz(1, begin + 20 * kMsNs, begin + 60 * kMsNs);
  return seen;
}

TEST(HostWatch, KnowsWhenACoreStoodStillAndCountsNoTickOfThatTime) {
  std::array<int, 2> begun{}, stood{};
  ASSERT_EQ(pipe(begun.data()) + pipe(stood.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    const Watched seen = watch(begun[1], stood[0]);
    _exit(write(begun[1], &seen, sizeof seen) == sizeof seen ? 0 : 1);
  }
  std::byte any{};
  Watched seen;
  ASSERT_EQ(read(begun[0], &any, 1), 1);
  kill(child, SIGSTOP);
  std::this_thread::sleep_for(100ms);
  kill(child, SIGCONT);
  std::this_thread::sleep_for(100ms);
  ASSERT_EQ(write(stood[1], &any, 1), 1);
  ASSERT_EQ(read(begun[0], &seen, sizeof seen), static_cast<ssize_t>(sizeof seen));
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  EXPECT_GT(seen.still, 0.095);
  EXPECT_LT(seen.still, 0.95 * seen.all) << "what ran is not taken for a pause";
  EXPECT_NEAR(seen.rate, 100 / (seen.all - seen.still), 1e-6);
  EXPECT_NEAR(seen.first_half, 0.05, 0.01) << "a pause's part within the time asked for";
  EXPECT_EQ(seen.within, 0) << "nothing but pause";
}

TEST(HostWatch, WhatOthersOfThisMachineTakeIsNotTheHosts) {
  const HostWatch host;
  std::this_thread::sleep_for(20ms);
  const std::int64_t begin = now_ns();
  if (!take_first_core(100 * kMsNs)) GTEST_SKIP() << "no real-time rights: no core can be taken";
  std::this_thread::sleep_for(20ms);
  EXPECT_LT(host.stood_still(begin, now_ns()), 0.05);
}

}  // namespace
}  // namespace palpate::testing
