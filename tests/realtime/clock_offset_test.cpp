#include "common/realtime/clock_offset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace palpate {
namespace {

/// Another clock and the ways to it and back. True time is the own clock.
struct Link {
  double shift_ns = 0, drift = 0;
  std::function<double()> there, back;  ///< [ns] delays
  std::int64_t theirs(std::int64_t own) const {
    return own + static_cast<std::int64_t>(std::llround(shift_ns + drift * static_cast<double>(own)));
  }
  ClockExchange ask(std::int64_t own) const {
    const auto arrives = own + static_cast<std::int64_t>(there());
    const auto leaves = arrives + 20'000;
    return {.sent = own,
            .received = theirs(arrives),
            .answered = theirs(leaves),
            .returned = leaves + static_cast<std::int64_t>(back())};
  }
};

constexpr std::int64_t kInterval = 125'000'000;

double error(const ClockOffset& offset, const Link& link, std::int64_t own) {
  return static_cast<double>(offset.at(own)->offset_ns) - static_cast<double>(link.theirs(own) - own);
}

TEST(ClockOffset, KnowsNothingBeforeTheFirstExchange) {
  EXPECT_FALSE(ClockOffset().at(0));
}

TEST(ClockOffset, HoldsTheTrueOffsetOverUnequalWaysAShiftAndADrift) {
  std::mt19937 random(1);
  std::exponential_distribution<double> queue(1e-6);  // 1 ms on average
  const Link link{.shift_ns = 1e9,
                  .drift = 100e-6,
                  .there = [&] { return 10e6 + queue(random); },
                  .back = [&] { return 30e6 + queue(random); }};
  ClockOffset offset;
  for (int i = 0; i < 2000; ++i) {
    const std::int64_t own = 1'000'000'000 + i * kInterval;
    offset.add(link.ask(own));
    if (i > 50 && i % 20 != 0) continue;
    for (const std::int64_t later : {own, own + kInterval, own + 20 * kInterval}) {
      ASSERT_LE(std::abs(error(offset, link, later)), static_cast<double>(offset.at(later)->uncertainty_ns)) << i;
      ASSERT_LE(std::abs(offset.at(later)->drift - link.drift), offset.at(later)->drift_uncertainty) << i;
    }
  }
  // Half the round trip is the least that anybody can know over such ways; the estimate is not much wider.
  const auto last = *offset.at(1'000'000'000 + 2000 * kInterval);
  EXPECT_GE(last.uncertainty_ns, 19'900'000);
  EXPECT_LE(last.uncertainty_ns, 21'000'000);
  EXPECT_NEAR(error(offset, link, 1'000'000'000 + 2000 * kInterval), -10e6,
              1e6);  // as a ping-pong, half the asymmetry off
}

TEST(ClockOffset, FindsTheDriftOverAGoodLink) {
  std::mt19937 random(2);
  std::exponential_distribution<double> queue(1e-5);  // 0.1 ms
  const auto way = [&] { return 30e3 + queue(random); };
  const Link link{.shift_ns = -5e12, .drift = -37e-6, .there = way, .back = way};
  ClockOffset offset;
  std::int64_t own = 0;
  for (int i = 0; i < 400; ++i) offset.add(link.ask(own += kInterval));
  const auto e = *offset.at(own);
  EXPECT_LE(std::abs(error(offset, link, own)), static_cast<double>(e.uncertainty_ns));
  EXPECT_LT(e.uncertainty_ns, 60'000);
  EXPECT_NEAR(1e6 * e.drift, -37, 2);
}

TEST(ClockOffset, GrowsLessSureWhileTheLinkIsCut) {
  const Link link{.shift_ns = 7e8, .drift = 50e-6, .there = [] { return 1e5; }, .back = [] { return 1e5; }};
  ClockOffset offset;
  std::int64_t own = 0;
  for (int i = 0; i < 80; ++i) offset.add(link.ask(own += kInterval));
  std::int64_t before = offset.at(own)->uncertainty_ns;
  for (int cut_s : {1, 10, 90}) {
    const std::int64_t later = own + cut_s * 1'000'000'000LL;
    EXPECT_LE(std::abs(error(offset, link, later)), static_cast<double>(offset.at(later)->uncertainty_ns));
    EXPECT_GT(offset.at(later)->uncertainty_ns, before);
    before = offset.at(later)->uncertainty_ns;
  }
  EXPECT_LT(before, 5'000'000);
}

TEST(ClockOffset, FollowsAClockThatWasSetAnew) {
  Link link{.shift_ns = 1e9, .drift = 0, .there = [] { return 2e5; }, .back = [] { return 3e5; }};
  ClockOffset offset;
  std::int64_t own = 0;
  for (int i = 0; i < 100; ++i) offset.add(link.ask(own += kInterval));
  link.shift_ns = -4e9;  // another machine took over
  offset.add(link.ask(own += kInterval));
  EXPECT_LE(std::abs(error(offset, link, own)), static_cast<double>(offset.at(own)->uncertainty_ns));
}

TEST(ClockOffset, IgnoresWhatCannotBe) {
  ClockOffset offset;
  offset.add({.sent = 100, .received = 5000, .answered = 9000, .returned = 200});  // answered longer than it was away
  offset.add({.sent = 300, .received = 5000, .answered = 5001, .returned = 200});
  EXPECT_FALSE(offset.at(300));
}

}  // namespace
}  // namespace palpate
