// Tissue whose own time falls behind is felt as it is, and told.
#include <gtest/gtest.h>

#include "common/models/moving/local_body.hpp"
#include "tests/haptic/local_models_for_tests.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kBallRadius = 0.008, kForce = 2;  // [m] of the tip; [N] of what it presses
constexpr std::int64_t kTickNs = 1'000'000;

/// A tool that rests on tissue whose deform node is the test itself.
class LateTissue : public ::testing::Test {
 protected:
  LateTissue() { haptic_.start(std::array{at_rest()}); }

  ToolDofs at_rest() const { return tip_at(scene_.tools[0], Vector3d::Zero()); }
  /// A step without a model.
  void feel() {
    haptic_.step(std::array{at_rest()});
    ++step_;
    late_steps_ += (haptic_.flags(0) & late_tissue) != 0;
  }
  /// A step with one of tissue that is so late [ns].
  void feel(std::int64_t late_ns, std::uint64_t run = 77) {
    LocalContactModel m = testing::empty_model(scene_.tools[0], Vector3d::Zero(), step_, ++seq_);
    if (pressed_) testing::add_contact(m, {0, 0, -kBallRadius}, {0, 0, -kForce}, 300);
    m.run = run;
    m.late_ns = late_ns_ = late_ns;
    ASSERT_TRUE(haptic_.consume(m));
    feel();
  }
  /// On time, for so many steps.
  void go_on(int steps) {
    for (int i = 0; i < steps; ++i) feel(late_ns_);
  }
  int take_late_steps() { return std::exchange(late_steps_, 0); }

  Scene scene_ = testing::moving_block_scene(kBallRadius);
  HapticStep haptic_{scene_, std::vector<Archive>(1)};
  std::uint64_t step_ = 0, seq_ = 0;
  std::int64_t late_ns_ = 0;
  int late_steps_ = 0;
  bool pressed_ = true;
};

TEST_F(LateTissue, ATickThatCameLateIsToldForAWhileAndChangesNoForce) {
  go_on(200);
  EXPECT_EQ(take_late_steps(), 0);
  const double before = haptic_.force(0).z();
  feel(15 * kTickNs);
  EXPECT_EQ(take_late_steps(), 1) << "at once";
  go_on(400);
  const int told = take_late_steps();
  EXPECT_GT(told, 20);
  EXPECT_LT(told, 100);
  EXPECT_EQ(haptic_.force(0).z(), before);
  EXPECT_EQ(haptic_.flags(0) & stale_model, 0u);
}

// Models that come each step are never too old, however slowly the tissue in them moves.
TEST_F(LateTissue, TissueThatGoesSlowlyIsToldFromATenthOn) {
  for (const auto& [share, told] : {std::pair{0.05, false}, {0.09, false}, {0.12, true}, {0.5, true}}) {
    go_on(1000);
    take_late_steps();
    for (int i = 0; i < 1000; ++i) feel(late_ns_ + std::llround(share * kTickNs));
    EXPECT_EQ(take_late_steps() > 0, told) << share;
  }
}

TEST_F(LateTissue, WhatTheNextTickMakesGoodIsNotLost) {
  for (int i = 0; i < 2000; ++i) feel(i % 2 == 0 ? 0 : kTickNs * 9 / 10);
  EXPECT_EQ(take_late_steps(), 0);
}

// Of a tool that has been away nothing is told meanwhile: twenty seconds in which a twentieth was lost.
TEST_F(LateTissue, WhatWasLostLongAgoIsNotLateNow) {
  pressed_ = false;
  go_on(10);
  for (int i = 0; i < 20'000; ++i) feel();
  pressed_ = true;
  feel(1000 * kTickNs);
  go_on(500);
  EXPECT_EQ(take_late_steps(), 0);
}

TEST_F(LateTissue, AnotherDeformNodeBeginsOnTime) {
  go_on(100);
  for (int i = 0; i < 100; ++i) feel(100'000 * kTickNs, 78);
  EXPECT_EQ(take_late_steps(), 0);
}

TEST_F(LateTissue, IsToldOfWhatIsFeltAlone) {
  pressed_ = false;
  for (int i = 0; i < 500; ++i) feel(late_ns_ + kTickNs);
  EXPECT_EQ(take_late_steps(), 0);
}

}  // namespace
}  // namespace palpate
