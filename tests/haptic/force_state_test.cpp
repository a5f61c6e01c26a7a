#include <gtest/gtest.h>

#include <array>

#include "common/sim/step_messages.hpp"
#include "tests/haptic/block_scene.hpp"
#include "tools/rig/tip_at.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kSmall = 1e-6;

// The force that a pressed and dragged tool is told of does the same work by either of its descriptions.
TEST(ForceStateOfAStep, HasAlongTheDofsWhatForceAndTorqueDo) {
  testing::BlockScene block;
  HapticStep step(block.scene, block.archives);
  const Tool& tool = block.scene.tools[0];
  const auto dofs_at = [&](int i) { return tip_at(tool, {1e-5 * i, 5e-6 * i, 0.02 - 8e-5 * i}); };
  step.start(std::array{dofs_at(0)});
  for (int i = 0; i <= 200; ++i) step.step(std::array{dofs_at(i)});
  StepRecord record{};
  prepare_record(step, record);
  fill_record(step, std::array{DeviceSample{dofs_at(200), 0}}, 200, 0, record);
  const ForceState told = force_state(record, 0);
  const Vector3d force(told.force[0], told.force[1], told.force[2]),
      torque(told.torque[0], told.torque[1], told.torque[2]);
  ASSERT_GT(force.norm(), 0.05);

  const Trocar trocar = make_trocar(tool.pivot, tool.axis, tool.up);
  const auto work = [&](double ToolDofs::*dof) {
    ToolDofs low = dofs_at(200), high = low;
    low.*dof -= kSmall;
    high.*dof += kSmall;
    const Eigen::Isometry3d from = tip_pose(trocar, low), to = tip_pose(trocar, high);
    const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
    return (force.dot(to.translation() - from.translation()) + turn.angle() * torque.dot(turn.axis())) / (2 * kSmall);
  };
  const double bound = 1e-7 * force.norm();
  EXPECT_NEAR(told.yaw_torque, work(&ToolDofs::yaw), bound);
  EXPECT_NEAR(told.pitch_torque, work(&ToolDofs::pitch), bound);
  EXPECT_NEAR(told.depth_force, work(&ToolDofs::depth), bound);
  EXPECT_NEAR(told.roll_torque, work(&ToolDofs::roll), bound);
  EXPECT_LT(told.depth_force, 0) << "pushed out of what it presses";
}

TEST(ForceStateOfAStep, IsTheSharesOfTheForceThatTheSceneGivesTheHandAndNoMoreThanItsLimit) {
  testing::BlockScene plain, scaled;
  scaled.scene.tools[0].force_scale = 3;
  HapticStep whole(plain.scene, plain.archives), more(scaled.scene, scaled.archives);
  scaled.scene.tools[0].max_force = 0.2;
  HapticStep limited(scaled.scene, scaled.archives);
  const auto dofs_at = [&](int i) { return std::array{tip_at(plain.scene.tools[0], {0, 0, 0.02 - 8e-5 * i})}; };
  for (HapticStep* step : {&whole, &more, &limited}) step->start(dofs_at(0));
  for (int i = 0; i <= 200; ++i) {
    for (HapticStep* step : {&whole, &more, &limited}) step->step(dofs_at(i));
    EXPECT_LT((more.force(0) - 3 * whole.force(0)).norm(), 1e-12);
  }
  EXPECT_GT(more.force(0).norm(), 0.3);
  EXPECT_NEAR(limited.force(0).norm(), 0.2, 1e-9);
}

}  // namespace
}  // namespace palpate
