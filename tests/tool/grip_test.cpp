#include "common/tool/grip.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "common/tool/jaws.hpp"
#include "tests/tool/example_forceps.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::kForceps;

const Eigen::Isometry3d kHere = Eigen::Isometry3d::Identity();
constexpr double kDt = 1e-3;

/// [m] between a jaw's axis and a point.
double away(double opening, ForcepsPart jaw, const Vector3d& p) {
  return (nearest_point(forceps_parts(kForceps, opening)[jaw].axis(kHere), p) - p).norm();
}

TEST(OpeningAtContact, TheLaterJawJustTouchesTheBall) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(0.004, 0.014), aside(-0.0015, 0.0015), height(-0.002, 0.002),
      size(0.0002, 0.0015);
  int touched = 0;
  for (int round = 0; round < 2000; ++round) {
    const Vector3d p(aside(random), height(random), along(random));
    const double radius = size(random), opening = opening_at_contact(kForceps, p, radius);
    if (opening == 0) continue;
    ++touched;
    const double a = away(opening, forceps_jaw_a, p), b = away(opening, forceps_jaw_b, p),
                 reach = kForceps.jaw_radius + radius;
    ASSERT_NEAR(std::max(a, b), reach, 1e-9);  // the other one is at it already
    ASSERT_GT(std::max(away(opening + 0.01, forceps_jaw_a, p), away(opening + 0.01, forceps_jaw_b, p)), reach);
  }
  EXPECT_GT(touched, 1000);
}

TEST(OpeningAtContact, WhatIsNotBetweenTheJawsDoesNotStopThem) {
  EXPECT_GT(opening_at_contact(kForceps, {0, 0, 0.01}, 0.001), 0);
  EXPECT_EQ(opening_at_contact(kForceps, {0, 0, 0.018}, 0.001), 0);      // ahead
  EXPECT_EQ(opening_at_contact(kForceps, {0, 0, -0.002}, 0.001), 0);     // behind the joint
  EXPECT_EQ(opening_at_contact(kForceps, {0.0021, 0, 0.01}, 0.001), 0);  // the jaws pass it
  EXPECT_EQ(opening_at_contact(kForceps, {0, 0.009, 0.01}, 0.001), 0);   // jaw B comes nowhere near
}

TEST(OpeningAtContact, ACatheterAcrossTheJawsStopsThemWhereverItsParticlesLie) {
  const double middle = opening_at_contact(kForceps, Vector3d(0, 0, 0.01), 0.00125);
  for (const double shift : {-0.004, 0.0, 0.0013, 0.0031}) {
    const Segment across{{shift - 0.004, 0, 0.01}, {shift + 0.004, 0, 0.01}};
    EXPECT_NEAR(opening_at_contact(kForceps, across, 0.00125), middle, 1e-12) << shift;
  }
  const Segment beside{{0.003, 0, 0.01}, {0.011, 0, 0.01}};
  EXPECT_EQ(opening_at_contact(kForceps, beside, 0.00125), 0);
}

TEST(OpeningAtContact, EachJawStopsAtItsOwnWallOfATube) {
  const std::vector<GripObstacle> walls{{{0, 0.002, 0.01}, 0.0004}, {{0, -0.002, 0.01}, 0.0004}};
  const double opening = opening_at_contact(kForceps, walls, 1.0);
  EXPECT_NEAR(away(opening, forceps_jaw_a, walls[0].position), 0.0014, 1e-9);
  EXPECT_NEAR(away(opening, forceps_jaw_b, walls[1].position), 0.0014, 1e-9);
  EXPECT_GT(opening, opening_at_contact(kForceps, walls[0].position, 0.0004));
  EXPECT_EQ(opening_at_contact(kForceps, walls, 0.3), 0);  // both are outside of jaws this far open
}

class GripTest : public ::testing::Test {
 protected:
  GripEvent step(double commanded, double load = 0) {
    return work_grip(grip_, law_, commanded, touch_, distance_, load, kDt);
  }
  /// Steps until the jaws come to rest; the last event other than none.
  GripEvent settle(double commanded, double load = 0) {
    GripEvent last = GripEvent::none;
    for (int i = 0; i < 200; ++i) {
      const GripEvent event = step(commanded, load);
      if (event != GripEvent::none) last = event;
    }
    return last;
  }
  GripLaw law_{.max_open = 1.0, .stiffness = 0.5, .friction = 0.8};
  Grip grip_ = grip_at(law_, 0.8);
  double touch_ = 0, distance_ = 0;
};

TEST_F(GripTest, EmptyJawsFollowTheHandleAtABoundedRateAndWithoutTorque) {
  double before = grip_.opening;
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(step(i < 50 ? 0.0 : 2.0), GripEvent::none);
    ASSERT_LE(std::abs(grip_.opening - before), law_.rate * kDt * (1 + 1e-12));
    ASSERT_EQ(grip_torque(grip_, law_), 0);
    before = grip_.opening;
  }
  EXPECT_EQ(grip_.opening, 1.0);  // no farther than they can
}

TEST_F(GripTest, AnObjectStopsTheJawsAndTheHandleFeelsItsStiffness) {
  touch_ = 0.3, distance_ = 0.01;
  EXPECT_EQ(settle(0.1), GripEvent::taken);
  EXPECT_EQ(grip_.opening, 0.3);
  EXPECT_NEAR(grip_torque(grip_, law_), 0.5 * 0.2, 1e-12);
  EXPECT_NEAR(grip_force(grip_, law_), 0.5 * 0.2 / 0.01, 1e-12);
  EXPECT_NEAR(grip_capacity(grip_, law_), 2 * 0.8 * 10, 1e-12);
  EXPECT_TRUE(grip_.holding);
}

TEST_F(GripTest, AHoldEndsWhenTheHandleOpensPastTheTouchAndNotBefore) {
  touch_ = 0.3, distance_ = 0.01;
  settle(0.1);
  EXPECT_EQ(settle(0.3 + 0.9 * kJawSlack), GripEvent::none);
  EXPECT_TRUE(grip_.holding);
  EXPECT_EQ(settle(0.3 + 1.1 * kJawSlack), GripEvent::released);
  EXPECT_FALSE(grip_.holding);
  EXPECT_EQ(settle(0.1), GripEvent::taken);
}

TEST_F(GripTest, ALoadBeyondTheFrictionOfBothJawsDropsTheObjectUntilTheJawsHaveOpened) {
  touch_ = 0.3, distance_ = 0.01;
  settle(0.28);
  const double most = grip_capacity(grip_, law_);
  EXPECT_NEAR(most, 2 * 0.8 * 0.5 * 0.02 / 0.01, 1e-12);
  EXPECT_EQ(step(0.28, 0.99 * most), GripEvent::none);
  EXPECT_EQ(step(0.28, 1.01 * most), GripEvent::dropped);
  EXPECT_EQ(settle(0.1), GripEvent::none);  // it has slipped: squeezing on does not bring it back
  EXPECT_FALSE(grip_.holding);
  settle(0.5);
  EXPECT_EQ(settle(0.1), GripEvent::taken);
}

TEST_F(GripTest, AnObjectThatVanishesIsLetGo) {
  touch_ = 0.3, distance_ = 0.01;
  settle(0.1);
  touch_ = 0;
  EXPECT_EQ(step(0.1), GripEvent::released);
  settle(0.1);
  EXPECT_EQ(grip_.opening, 0.1);
  EXPECT_EQ(grip_torque(grip_, law_), 0);
}

TEST_F(GripTest, AnObjectThatIsWedgedDeeperOpensTheJaws) {
  touch_ = 0.3, distance_ = 0.01;
  settle(0.1);
  touch_ = 0.5, distance_ = 0.006;
  settle(0.1);
  EXPECT_EQ(grip_.opening, 0.5);
  EXPECT_NEAR(grip_torque(grip_, law_), 0.5 * 0.4, 1e-12);
}

TEST_F(GripTest, ACommandThatIsNoNumberLeavesTheHandleWhereItIs) {
  settle(0.4);
  step(std::nan(""));
  EXPECT_EQ(grip_.commanded, 0.4);
  EXPECT_EQ(grip_.opening, 0.4);
}

TEST_F(GripTest, ARestoredGripGoesOnAlike) {
  touch_ = 0.3, distance_ = 0.01;
  for (int i = 0; i < 20; ++i) step(0.1);
  Grip copy;
  std::memcpy(static_cast<void*>(&copy), &grip_, sizeof copy);
  for (int i = 0; i < 50; ++i) {
    const double commanded = 0.1 + 0.01 * i, load = 0.3 * i;
    ASSERT_EQ(step(commanded, load), work_grip(copy, law_, commanded, touch_, distance_, load, kDt));
    ASSERT_EQ(copy.opening, grip_.opening);
    ASSERT_EQ(copy.holding, grip_.holding);
  }
}

}  // namespace
}  // namespace palpate
