// A forceps on moving tissue is one as on a duct: its jaws stop at what is between them, hold it, slip and let go.
#include <gtest/gtest.h>

#include "common/mesh/generators.hpp"
#include "common/sim/simulator.hpp"
#include "tests/sim/played_scenes.hpp"

namespace palpate::sim {
namespace {

using Eigen::Vector3d;

constexpr double kHeight = 0.02, kThickness = 0.004;  // [m] of a fin that stands along x on the plane z = 0

/// A fin under a forceps whose jaws turn in the plane x = 0 and take it between them.
class ForcepsOnAFin : public ::testing::Test {
 protected:
  ForcepsOnAFin() {
    TensorMassSpec fin;
    fin.name = "fin";
    fin.material = {2e4, 0.3, 1000};
    fin.fixed.push_back({.where = {.indices = {}, .box = {}, .group = "bottom"}});
    fin.dynamic.damping = 60;
    scene_.bodies.push_back(fin);
    Tool tool;
    tool.name = "forceps";
    tool.pivot = {0, 0, 0.3};
    tool.axis = -Vector3d::UnitZ();
    tool.up = Vector3d::UnitY();
    tool.end = ForcepsSpec{.jaws = {.length = 0.012, .radius = 0.001, .max_open = 1.2, .friction = 0.2}};
    tool.max_force = 20;
    tool.max_force_rate = 1e5;
    scene_.tools.push_back(tool);
    const TetMesh mesh = make_block({-0.015, -kThickness / 2, 0}, {0.015, kThickness / 2, kHeight}, {15, 2, 10});
    archives_.push_back(precompute_moving(fin, kind_of(scene_.bodies[0]), mesh));
    simulator_.emplace(scene_, archives_);
    simulator_->start(input());
  }

  std::array<ToolInput, 1> input() const {
    ToolDofs d = tip_at(scene_.tools[0], {0, 0, height_});
    d.grip = grip_;
    return {ToolInput{d}};
  }
  /// Goes there evenly, in so many steps.
  void go(double height, double grip, int steps) {
    const double dh = (height - height_) / steps, dg = (grip - grip_) / steps;
    for (int i = 0; i < steps; ++i) {
      height_ += dh;
      grip_ += dg;
      simulator_->step(input());
    }
  }
  bool holds() const { return simulator_->tissue().organ(0).holds(0); }
  ToolView tool() const { return simulator_->tool(0); }

  Scene scene_;
  std::vector<Archive> archives_;
  std::optional<Simulator> simulator_;
  double height_ = kHeight + 0.025, grip_ = 1.0;
};

constexpr double kOver = kHeight + 0.009;  // [m] of the joint: the jaws reach 3 mm down both sides

TEST_F(ForcepsOnAFin, ItsJawsStopAtTheTissueAndTheHandleFeelsIt) {
  go(kOver, 1.0, 400);
  EXPECT_FALSE(holds());
  EXPECT_EQ(tool().grip_torque, 0);
  go(kOver, 0.0, 400);
  EXPECT_TRUE(holds());
  // Each meets an edge of the fin at 9 mm from the joint: 2 (atan(2/9) + asin(1/9.2)) = 0.65 rad.
  EXPECT_NEAR(tool().opening, 0.65, 0.05);
  EXPECT_NEAR(tool().grip_torque, std::get<ForcepsSpec>(scene_.tools[0].end).jaws.grip_stiffness * tool().opening,
              0.01);
}

TEST_F(ForcepsOnAFin, WhatIsHeldFollowsAndPullsBack) {
  go(kOver, 1.0, 400);
  go(kOver, 0.0, 400);
  ASSERT_TRUE(holds());
  const double before = tool().force.z();
  go(kOver + 0.002, 0.0, 400);
  go(kOver + 0.002, 0.0, 300);
  EXPECT_LT(tool().force.z(), before - 0.05);
  EXPECT_TRUE(holds());
  go(kOver + 0.002, 1.0, 200);
  EXPECT_FALSE(holds());
  EXPECT_EQ(tool().grip_torque, 0);
}

TEST_F(ForcepsOnAFin, ALoadBeyondFrictionSlipsOutAndIsNotTakenAgainAtOnce) {
  go(kOver, 1.0, 400);
  go(kOver, 0.645, 400);  // lightly
  const double light = tool().grip_torque;
  ASSERT_TRUE(holds());
  ASSERT_GT(light, 0);
  double pulled = 0;
  for (int i = 0; i < 80 && holds(); ++i) {
    go(height_ + 0.0002, grip_, 20);
    pulled = std::min(pulled, tool().force.z());
  }
  EXPECT_FALSE(holds());
  EXPECT_LT(pulled, -0.02);
  go(height_, grip_, 300);
  EXPECT_FALSE(holds());
  EXPECT_GT(tool().force.z(), 0.5 * pulled);
}

}  // namespace
}  // namespace palpate::sim
