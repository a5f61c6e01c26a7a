#include "tests/network/lane.hpp"

#include <gtest/gtest.h>

#include <string>

namespace palpate::testing {
namespace {

constexpr std::int64_t kMs = 1'000'000;

struct Arrival {
  int number;
  std::int64_t time;  ///< [ns]
};

/// Sends numbered packets of `bytes`, one each `gap`, and takes each at the moment when it is due.
std::vector<Arrival> cross(const std::string& words, int packets, std::int64_t gap, int bytes = 100,
                           std::uint64_t seed = 1) {
  Lane lane(seed);
  Impairment impairment;
  std::istringstream in(words);
  EXPECT_TRUE(change(impairment, in)) << words;
  lane.set(impairment);
  std::vector<Arrival> arrivals;
  const auto take_until = [&](std::int64_t end) {
    while (lane.next_due() <= end) {
      const std::int64_t now = lane.next_due();
      EXPECT_FALSE(lane.take(now - 1)) << "before it is due";
      const auto packet = lane.take(now);
      EXPECT_EQ(packet->size(), static_cast<std::size_t>(bytes));
      arrivals.push_back({(*packet)[0] + 256 * (*packet)[1], now});
    }
  };
  for (int i = 0; i < packets; ++i) {
    take_until(i * gap - 1);
    std::vector<std::uint8_t> packet(bytes);
    packet[0] = static_cast<std::uint8_t>(i % 256);
    packet[1] = static_cast<std::uint8_t>(i / 256);
    lane.put(packet, i * gap);
  }
  take_until(Lane::kNever - 1);
  return arrivals;
}

int overtaken(const std::vector<Arrival>& arrivals) {
  int count = 0, newest = -1;
  for (const Arrival& a : arrivals) {
    count += a.number < newest;
    newest = std::max(newest, a.number);
  }
  return count;
}

TEST(Lane, AGoodLineChangesNothing) {
  const auto arrivals = cross("", 1000, kMs);
  ASSERT_EQ(arrivals.size(), 1000u);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(arrivals[i].number, i);
    EXPECT_EQ(arrivals[i].time, i * kMs);
  }
}

TEST(Lane, DelayIsExactAndJitterIsSpreadEvenlyInOrder) {
  for (const Arrival& a : cross("delay 0.1", 100, kMs)) EXPECT_EQ(a.time, a.number * kMs + 100 * kMs);
  const auto arrivals = cross("delay 0.1 jitter 0.02", 2000, 50 * kMs);
  double sum = 0;
  for (const Arrival& a : arrivals) {
    const double later = 1e-6 * static_cast<double>(a.time - a.number * 50 * kMs) - 100;
    ASSERT_GE(later, 0);
    ASSERT_LE(later, 20);
    sum += later;
  }
  EXPECT_NEAR(sum / 2000, 10, 1);
  EXPECT_EQ(overtaken(cross("jitter 0.02", 2000, kMs)), 0);
}

TEST(Lane, LossDuplicatesAndOrderAreInTheSharesAskedFor) {
  EXPECT_NEAR(static_cast<double>(cross("loss 0.3", 10000, kMs).size()), 7000, 200);
  EXPECT_NEAR(static_cast<double>(cross("duplicate 0.1", 10000, kMs).size()), 11000, 150);
  const auto mixed = cross("reorder 0.2", 10000, kMs);
  EXPECT_EQ(mixed.size(), 10000u);
  EXPECT_NEAR(overtaken(mixed), 2000, 200);
  EXPECT_TRUE(cross("loss 1", 100, kMs).empty());
}

TEST(Lane, TheLinesRateIsKeptAndItsQueueBounded) {
  // 1,000 bytes each ms over a line of 4 Mbit/s: half of it passes, each 2 ms after the one before.
  const auto arrivals = cross("rate 4e6 queue 10000", 2000, kMs, 1000);
  EXPECT_NEAR(static_cast<double>(arrivals.size()), 1005, 6);
  for (std::size_t i = 1; i < arrivals.size(); ++i) EXPECT_EQ(arrivals[i].time - arrivals[i - 1].time, 2 * kMs);
  for (const Arrival& a : arrivals) EXPECT_LE(a.time - a.number * kMs, 20 * kMs) << "ten packets wait at most";
}

TEST(Lane, ACutLosesWhatIsOnItsWay) {
  Lane lane(1);
  const std::vector<std::uint8_t> packet{1};
  lane.set({.delay = 0.1});
  lane.put(packet, 0);
  lane.set({.delay = 0.1, .cut = true});
  EXPECT_EQ(lane.next_due(), Lane::kNever);
  lane.put(packet, 10 * kMs);
  EXPECT_EQ(lane.next_due(), Lane::kNever);
  lane.set({.delay = 0.1});
  lane.put(packet, 20 * kMs);
  EXPECT_EQ(lane.next_due(), 120 * kMs);
}

TEST(Lane, TheSameSeedDoesTheSame) {
  const auto numbers = [](std::uint64_t seed) {
    std::vector<std::int64_t> all;
    for (const Arrival& a : cross("delay 0.01 jitter 0.01 loss 0.2 duplicate 0.1 reorder 0.1", 500, kMs, 100, seed))
      all.push_back(a.time);
    return all;
  };
  EXPECT_EQ(numbers(7), numbers(7));
  EXPECT_NE(numbers(7), numbers(8));
}

TEST(Lane, NonsenseIsNotUnderstood) {
  for (const char* words : {"delays 1", "delay", "delay x", "loss -1"}) {
    Impairment impairment;
    std::istringstream in(words);
    EXPECT_FALSE(change(impairment, in)) << words;
  }
}

}  // namespace
}  // namespace palpate::testing
