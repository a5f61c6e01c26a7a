#include "web_node/standing_hand.hpp"

#include <gtest/gtest.h>

namespace palpate::web {
namespace {

constexpr std::int64_t kMs = 1'000'000;

Said sample(std::uint32_t number) {
  return {.kind = Said::sample, .tool = 1, .motion = {.number = number, .tip = {0.1, 0.2, 0.3}}, .number = number};
}

TEST(WebStandingHand, SaysItsLastSampleByNewNumbersForASecond) {
  StandingHand hand;
  EXPECT_FALSE(hand.again(0)) << "nothing was said";
  hand.heard(sample(64), 0);
  std::uint32_t number = 64;
  for (std::int64_t now = 24; now <= 1000; now += 24) {
    hand.answered(now * kMs);
    const auto again = hand.again(now * kMs);
    ASSERT_TRUE(again) << now << " ms";
    EXPECT_EQ(again->motion.number, ++number);
    EXPECT_EQ(again->tool, 1);
    EXPECT_TRUE(again->motion.again);
    EXPECT_EQ(again->motion.tip, Eigen::Vector3d(0.1, 0.2, 0.3));
  }
  EXPECT_LT(number, 128u) << "below the page's next number";
  hand.answered(1008 * kMs);
  EXPECT_FALSE(hand.again(1008 * kMs)) << "a page that hangs";
  hand.heard(sample(128), 1100 * kMs);
  EXPECT_EQ(hand.again(1124 * kMs)->motion.number, 129u);
}

TEST(WebStandingHand, WaitsForTheBrowsersAnswer) {
  StandingHand hand;
  hand.heard(sample(64), 0);
  EXPECT_TRUE(hand.again(24 * kMs));
  EXPECT_TRUE(hand.again(96 * kMs));
  EXPECT_FALSE(hand.again(120 * kMs));
  EXPECT_TRUE(hand.stands(120 * kMs)) << "and the browser is asked again";
  hand.answered(130 * kMs);
  EXPECT_TRUE(hand.again(144 * kMs)) << "a browser that was slow for a moment";
  EXPECT_FALSE(hand.again(240 * kMs)) << "and is silent again";
  hand.answered(1000 * kMs);
  EXPECT_FALSE(hand.again(1008 * kMs)) << "the page has been silent for too long";
  EXPECT_FALSE(hand.stands(1008 * kMs));
}

TEST(WebStandingHand, EndsWhereThePageLetsGoAndNotWhereItTakesFrames) {
  for (const Said::Kind kind : {Said::release, Said::give, Said::rest}) {
    StandingHand hand;
    hand.heard(sample(64), 0);
    hand.heard({.kind = kind}, kMs);
    EXPECT_FALSE(hand.again(24 * kMs)) << int{kind};
  }
  StandingHand hand;
  hand.heard(sample(64), 0);
  hand.heard({.kind = Said::taken}, kMs);
  EXPECT_TRUE(hand.again(24 * kMs));
}

}  // namespace
}  // namespace palpate::web
