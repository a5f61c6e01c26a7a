#include "common/bus/clock_link.hpp"

#include <gtest/gtest.h>

#include "common/bus/memory_bus.hpp"

namespace palpate {
namespace {

/// Two nodes on one machine whose monotonic clocks are the same: the estimate is exact.
TEST(ClockLink, NodesOnOneMachineHaveOneClock) {
  const auto network = make_memory_network();
  const auto haptic = make_memory_bus(network), render = make_memory_bus(network);
  ClockServer server(*haptic, "haptic 1@here");
  ClockFollower follower(*render, "render 2@here");
  EXPECT_FALSE(follower.known());
  EXPECT_EQ(follower.to_own(123), 123);
  follower.follow();
  server.answer();
  follower.follow();
  ASSERT_TRUE(follower.known());
  EXPECT_EQ(follower.of(), "haptic 1@here");
  EXPECT_EQ(follower.to_own(123), 123);
  EXPECT_EQ(follower.estimate().uncertainty_ns, 0);
  EXPECT_GT(follower.round_trip_ns(), 0);
}

/// A stranger's answer, as from another machine: its clock is a second ahead.
TEST(ClockLink, ATimeOfAnotherMachineIsToldOnTheOwnClock) {
  const auto network = make_memory_network();
  const auto haptic = make_memory_bus(network), render = make_memory_bus(network);
  std::int64_t time = 5'000'000'000;
  ClockFollower follower(*render, "render 2@here", [&] { return time; });
  const auto probes = haptic->reader(topics::clock_probe);
  const auto answers = haptic->writer(topics::clock_answer);
  for (int i = 0; i < 50; ++i) {
    follower.follow();
    time += 10'000'000;
    const auto probe = probes->take();
    ASSERT_TRUE(probe);
    const std::int64_t theirs = time + 1'000'000'000;
    answers->write({.node = probe->node,
                    .clock_of = "haptic 1@there",
                    .host = "another",
                    .seq = probe->seq,
                    .probe_ns = probe->publish_ns,
                    .receive_ns = theirs,
                    .publish_ns = theirs});
    time += 30'000'000;
    follower.follow();
    time += ClockFollower::kIntervalNs;
  }
  ASSERT_TRUE(follower.known());
  const auto estimate = follower.estimate();
  EXPECT_LE(std::abs(estimate.offset_ns - 1'000'000'000), estimate.uncertainty_ns);
  EXPECT_NEAR(static_cast<double>(follower.to_own(8'000'000'000)), 7'000'000'000.0, 21e6);
  EXPECT_EQ(follower.round_trip_ns(), 40'000'000);
}

TEST(ClockLink, AnswersForOthersAreLeftAlone) {
  const auto network = make_memory_network();
  const auto haptic = make_memory_bus(network), render = make_memory_bus(network);
  ClockFollower follower(*render, "render 2@here");
  follower.follow();
  haptic->writer(topics::clock_answer)
      ->write({.node = "deform 3@here", .clock_of = "haptic 1@there", .seq = 1, .publish_ns = 5});
  follower.follow();
  EXPECT_FALSE(follower.known());
}

TEST(ClockLink, AsksAtItsOwnPace) {
  const auto network = make_memory_network();
  const auto haptic = make_memory_bus(network), render = make_memory_bus(network);
  const auto probes = haptic->reader(topics::clock_probe, Keep::all);
  std::int64_t time = 1'000'000'000;
  ClockFollower follower(*render, "render 2@here", [&] { return time; });
  int asked = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    follower.follow();
    time += 1'000'000;
    while (probes->take()) ++asked;
  }
  EXPECT_EQ(asked, 8);
}

}  // namespace
}  // namespace palpate
