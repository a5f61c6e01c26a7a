#include "common/tool/kinematics.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <stdexcept>

namespace palpate {
namespace {

constexpr double kPi = std::numbers::pi;

class Kinematics : public testing::Test {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  Eigen::Vector3d vector(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
  Trocar trocar() { return make_trocar(vector(1), vector(1), vector(1)); }
  ToolDofs dofs() {
    return {.yaw = uniform(-3, 3),
            .pitch = uniform(-1.5, 1.5),
            .depth = uniform(0.01, 0.3),
            .roll = uniform(-3, 3)};
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
  const auto tip = [&](const ToolDofs& dofs) {
    return Eigen::Vector3d(tip_pose(trocar, dofs).translation());
  };
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

}  // namespace
}  // namespace palpate
