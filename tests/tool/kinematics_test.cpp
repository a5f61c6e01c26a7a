#include "common/tool/kinematics.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <stdexcept>

namespace palpate {
namespace {

constexpr double kPi = std::numbers::pi;

class Kinematics : public ::testing::Test {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  Eigen::Vector3d vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  Trocar trocar() { return make_trocar(vector(1), vector(1), vector(1)); }
  ToolDofs dofs() {
    return {.yaw = uniform(-3, 3), .pitch = uniform(-1.5, 1.5), .depth = uniform(0.01, 0.3), .roll = uniform(-3, 3)};
  }

 private:
  std::mt19937 random_{7};
};

TEST_F(Kinematics, ZeroPoseLiesAlongTheAxisWithYUp) {
  const Trocar trocar = make_trocar({1, 2, 3}, {0, 0, -2}, {0, 5, 1});
  const Eigen::Isometry3d pose = tip_pose(trocar, {.depth = 0.1});
  EXPECT_NEAR((pose.translation() - Eigen::Vector3d(1, 2, 2.9)).norm(), 0, 1e-15);
  EXPECT_NEAR((pose.linear().col(2) - Eigen::Vector3d(0, 0, -1)).norm(), 0, 1e-15);
  EXPECT_NEAR((pose.linear().col(1) - Eigen::Vector3d(0, 1, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((pose.linear().col(0) - Eigen::Vector3d(-1, 0, 0)).norm(), 0, 1e-15);
}

TEST_F(Kinematics, SignsFollowTheRightHandRule) {
  const Trocar trocar = make_trocar(Eigen::Vector3d::Zero(), {0, 0, 1}, {0, 1, 0});
  const auto tip = [&](const ToolDofs& dofs) { return Eigen::Vector3d(tip_pose(trocar, dofs).translation()); };
  EXPECT_NEAR((tip({.yaw = kPi / 2, .depth = 1}) - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((tip({.pitch = kPi / 2, .depth = 1}) - Eigen::Vector3d(0, -1, 0)).norm(), 0, 1e-15);
  const Eigen::Isometry3d rolled = tip_pose(trocar, {.depth = 1, .roll = kPi / 2});
  EXPECT_NEAR((rolled.linear().col(0) - Eigen::Vector3d(0, 1, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((rolled.translation() - Eigen::Vector3d(0, 0, 1)).norm(), 0, 1e-15);
}

TEST_F(Kinematics, TipFrameIsARotation) {
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Matrix3d r = tip_pose(trocar(), dofs()).linear();
    ASSERT_NEAR((r.transpose() * r - Eigen::Matrix3d::Identity()).norm(), 0, 1e-13);
    ASSERT_NEAR(r.determinant(), 1, 1e-13);
  }
}

TEST_F(Kinematics, DofsForTheTipAreTheInverse) {
  for (int i = 0; i < 1000; ++i) {
    const Trocar t = trocar();
    const ToolDofs there = dofs();
    const ToolDofs back = dofs_for_tip(t, tip_pose(t, there).translation(), there.roll);
    ASSERT_NEAR(back.yaw, there.yaw, 1e-11);
    ASSERT_NEAR(back.pitch, there.pitch, 1e-11);
    ASSERT_NEAR(back.depth, there.depth, 1e-13);
    ASSERT_EQ(back.roll, there.roll);
  }
}

TEST_F(Kinematics, GeneralisedForceDoesTheWorkOfTheTipForce) {
  for (int i = 0; i < 200; ++i) {
    const Trocar t = trocar();
    const ToolDofs at = dofs();
    const Eigen::Vector3d force = vector(5), torque = vector(0.5);
    const Eigen::Vector4d q = generalised_force(t, at, force, torque);
    const double h = 1e-6;
    for (int k = 0; k < 4; ++k) {
      ToolDofs plus = at, minus = at;
      double ToolDofs::*const dof[] = {&ToolDofs::yaw, &ToolDofs::pitch, &ToolDofs::depth, &ToolDofs::roll};
      plus.*dof[k] += h;
      minus.*dof[k] -= h;
      const Eigen::Isometry3d a = tip_pose(t, minus), b = tip_pose(t, plus);
      const Eigen::AngleAxisd turn(Eigen::Matrix3d(b.linear() * a.linear().transpose()));
      const Eigen::Vector3d moved = b.translation() - a.translation(), turned = turn.angle() * turn.axis();
      ASSERT_NEAR(q[k], (force.dot(moved) + torque.dot(turned)) / (2 * h), 1e-7);
    }
  }
}

TEST_F(Kinematics, ParallelOrZeroDirectionsAreRefused) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), zero = Eigen::Vector3d::Zero();
  EXPECT_THROW(make_trocar(zero, x, -2 * x), std::runtime_error);
  EXPECT_THROW(make_trocar(zero, zero, x), std::runtime_error);
  EXPECT_THROW(make_trocar(zero, x, zero), std::runtime_error);
}

TEST(TrocarReaction, ForcesAndMomentsBalanceInEveryPose) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> angle(-1.2, 1.2), depth(0.02, 0.28), unit(-1, 1);
  const auto vector = [&] { return Eigen::Vector3d(unit(random), unit(random), unit(random)); };
  for (int round = 0; round < 500; ++round) {
    const Trocar trocar = make_trocar(vector(), vector(), vector());
    const ToolDofs dofs{
        .yaw = angle(random), .pitch = angle(random), .depth = depth(random), .roll = 3 * angle(random)};
    const Eigen::Vector3d force = 5 * vector(), torque = 0.1 * vector();
    const double length = 0.3;
    const LeverForces lever = trocar_reaction(trocar, dofs, length, force, torque);
    const Eigen::Isometry3d tip = tip_pose(trocar, dofs);
    const Eigen::Vector3d along = tip.linear().col(2), handle = tip.translation() - length * along;
    ASSERT_LT((force + lever.trocar + lever.hand).norm(), 1e-12);
    const Eigen::Vector3d moments = torque + tip.translation().cross(force) + trocar.pivot.cross(lever.trocar) +
                                    handle.cross(lever.hand) + lever.twist;
    ASSERT_LT(moments.norm(), 1e-12);
    ASSERT_LT(std::abs(lever.trocar.dot(along)), 1e-12);  // a pivot holds nothing along the shaft
    ASSERT_LT(lever.twist.cross(along).norm(), 1e-12);    // and the hand's moment is against the roll alone
    ASSERT_NEAR(lever.twist.dot(along), -torque.dot(along), 1e-12);
    ASSERT_NEAR(lever.hand.dot(along), -force.dot(along), 1e-12);
  }
}

TEST(TrocarReaction, ALeverOfEqualArmsBearsTwiceTheForceAtItsPivot) {
  const Trocar trocar = make_trocar({0, 0, 0}, -Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY());
  const LeverForces lever = trocar_reaction(trocar, {.depth = 0.15}, 0.3, {2, 0, 0}, Eigen::Vector3d::Zero());
  EXPECT_LT((lever.hand - Eigen::Vector3d(2, 0, 0)).norm(), 1e-12);
  EXPECT_LT((lever.trocar - Eigen::Vector3d(-4, 0, 0)).norm(), 1e-12);
}

TEST(TrocarReaction, AHandleAtTheTrocarKeepsTheForcesBoundedAndTheBalance) {
  const Trocar trocar = make_trocar({0, 0, 0}, -Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY());
  for (const double depth : {0.295, 0.3, 0.31}) {
    const Eigen::Vector3d force(2, 1, 3), torque(0, 0.01, 0.02);
    const LeverForces lever = trocar_reaction(trocar, {.depth = depth}, 0.3, force, torque);
    EXPECT_LT(lever.hand.norm(), 100);
    EXPECT_LT((force + lever.trocar + lever.hand).norm(), 1e-12);
    const Eigen::Vector3d tip(0, 0, -depth), handle(0, 0, 0.3 - depth);
    EXPECT_LT((torque + tip.cross(force) + handle.cross(lever.hand) + lever.twist).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace palpate
