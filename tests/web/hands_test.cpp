#include "web_node/hands.hpp"

#include <gtest/gtest.h>

namespace palpate::web {
namespace {

constexpr std::uint64_t kFirst = 1000;

class WebHands : public ::testing::Test {
 protected:
  std::optional<DeviceState> move(std::uint32_t page, std::uint32_t number, int tool = 0) {
    return hands_.move(tool, page, {.number = number, .tip = {0.01, 0.02, -0.1}, .roll = 0.3, .grip = 0.2}, now_);
  }
  std::uint32_t holder() const { return hands_.view(0, 0).holder; }

  Hands hands_{{{true, {}}, {false, {}}}, kFirst};
  double now_ = 10;
};

TEST_F(WebHands, OnePageHoldsAToolAndAnotherMayAskForIt) {
  EXPECT_FALSE(move(1, 1)) << "not taken yet";
  hands_.take(0, 1, now_);
  EXPECT_EQ(holder(), 1u);
  hands_.take(0, 2, now_);
  EXPECT_EQ(holder(), 1u);
  EXPECT_EQ(hands_.view(0, 0).asker, 2u);
  EXPECT_FALSE(move(2, 1));
  EXPECT_TRUE(move(1, 1));
  hands_.give(0, 2);
  EXPECT_EQ(holder(), 1u) << "the holder's word alone";
  hands_.give(0, 1);
  EXPECT_EQ(holder(), 2u);
  EXPECT_TRUE(move(2, 1));
  EXPECT_FALSE(move(1, 2));
}

TEST_F(WebHands, AReleasedToolGoesToWhoHasAskedAndAClosedPageHoldsNothing) {
  hands_.take(0, 1, now_);
  hands_.take(0, 2, now_);
  hands_.release(0, 1);
  EXPECT_EQ(holder(), 2u);
  hands_.gone(2);
  EXPECT_EQ(holder(), 0u);
}

TEST_F(WebHands, WhoIsSilentForSecondsLosesTheToolToWhoWantsIt) {
  hands_.take(0, 1, now_);
  move(1, 1);
  hands_.take(0, 2, now_ + Hands::kIdle + 0.1);
  EXPECT_EQ(holder(), 2u);
}

// The server's word for a page that is silent is not the page's own.
TEST_F(WebHands, WhatIsSaidAgainForASilentPageDoesNotKeepTheTool) {
  hands_.take(0, 1, now_);
  move(1, 1);
  EXPECT_TRUE(hands_.move(0, 1, {.number = 2, .tip = {0.01, 0.02, -0.1}, .again = true}, now_ + 1));
  hands_.take(0, 2, now_ + Hands::kIdle + 0.1);
  EXPECT_EQ(holder(), 2u);
}

TEST_F(WebHands, ATwiceToldSampleMovesNothing) {
  hands_.take(0, 1, now_);
  EXPECT_TRUE(move(1, 5));
  EXPECT_FALSE(move(1, 5));
  EXPECT_FALSE(move(1, 4));
  EXPECT_TRUE(move(1, 6));
}

TEST_F(WebHands, AToolThatIsNotOfferedOrNotThereIsNotTaken) {
  hands_.take(1, 1, now_);
  hands_.take(7, 1, now_);
  hands_.release(7, 1);
  hands_.give(-1, 1);
  EXPECT_FALSE(move(1, 1, 1));
  EXPECT_FALSE(move(1, 1, 7));
}

TEST_F(WebHands, TheTipGoesWhereThePageSaysAndItsNumberComesBack) {
  hands_.take(0, 3, now_);
  const auto state = move(3, 42);
  ASSERT_TRUE(state);
  const Eigen::Isometry3d pose = tip_pose({}, {state->yaw, state->pitch, state->depth, state->roll, state->grip});
  EXPECT_NEAR((pose.translation() - Eigen::Vector3d(0.01, 0.02, -0.1)).norm(), 0, 1e-12);
  EXPECT_EQ(state->seq, kFirst + 1);
  EXPECT_EQ(hands_.view(0, state->seq).sample, 42u);
  EXPECT_EQ(hands_.view(0, kFirst).sample, 0u) << "from before it took the tool";
  hands_.take(0, 4, now_ + 10);
  EXPECT_EQ(hands_.view(0, state->seq).sample, 0u) << "another's";
}

TEST_F(WebHands, WhatAPageLeavesOutIsNoGapOnTheBus) {
  hands_.take(0, 3, now_);
  for (std::uint32_t i = 1; i <= 400; ++i) {
    const auto state = move(3, 64 * i);
    ASSERT_TRUE(state);
    EXPECT_EQ(state->seq, kFirst + i);
    EXPECT_EQ(hands_.view(0, state->seq).sample, 64 * i);
    if (i <= 20) continue;
    EXPECT_EQ(hands_.view(0, state->seq - 20).sample, 64 * (i - 20)) << "the haptic node is behind";
  }
  EXPECT_EQ(hands_.view(0, kFirst + 1).sample, 0u) << "long ago";
}

}  // namespace
}  // namespace palpate::web
