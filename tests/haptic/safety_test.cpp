#include "common/tool/safety.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "idl/messages.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

TEST(Safety, TheForceNeverExceedsItsLimitAndTorqueShrinksWithIt) {
  SafetyChain chain(5.0, 1e9, 1e-3);
  Vector3d force(30, 0, 40), torque(1, 2, 3);
  const auto flags = chain.apply(force, torque, true);
  EXPECT_EQ(flags, force_limited);
  EXPECT_NEAR(force.norm(), 5.0, 1e-12);
  EXPECT_NEAR((torque - 0.1 * Vector3d(1, 2, 3)).norm(), 0, 1e-12);
}

TEST(Safety, ATorqueWithoutForceIsLimitedToo) {
  const double most = 5 * SafetyChain::kMaxLever;
  SafetyChain chain(5.0, 1000, 1e-3);
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i < 20; ++i) {
    Vector3d force(1e-3, 0, 0), torque(0, 5e8, 0);
    EXPECT_TRUE(chain.apply(force, torque, true) & force_limited);
    EXPECT_LE(torque.norm(), most + 1e-12);
    EXPECT_LE((torque - last).norm(), 1000 * 1e-3 * SafetyChain::kMaxLever + 1e-12);
    last = torque;
  }
  EXPECT_NEAR(last.norm(), most, 1e-9);
}

TEST(Safety, TheForceRisesNoFasterThanItsSlewLimitInAnyDirection) {
  SafetyChain chain(10.0, 250, 1e-3);
  Vector3d force(0, 0, 8), torque = Vector3d::Zero();
  for (int i = 1; i <= 20; ++i) {
    force = {0, 0, 8};
    EXPECT_EQ(chain.apply(force, torque, true), slew_limited);
    EXPECT_NEAR(force.z(), 0.25 * i, 1e-12);
  }
  force = {8, 0, 5};
  EXPECT_EQ(chain.apply(force, torque, true), slew_limited);
  EXPECT_LT((force - Vector3d(0.25, 0, 5)).norm(), 1e-12) << "turned aside";
}

TEST(Safety, AForceThatGoesIsNotHeldButNoneComesFromTheOtherSideAtOnce) {
  SafetyChain chain(10.0, 250, 1e-3);
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
  for (int i = 0; i < 40; ++i) {
    force = {0, 0, 8};
    chain.apply(force, torque, true);
  }
  force = {0, 0, 3.5};
  EXPECT_EQ(chain.apply(force, torque, true), 0u);
  EXPECT_EQ(force.z(), 3.5);
  force = {0, 0, -8};
  EXPECT_EQ(chain.apply(force, torque, true), slew_limited);
  EXPECT_NEAR(force.z(), -0.25, 1e-12);
}

TEST(Safety, AFaultRampsToZeroWithinFiveMillisecondsAndStays) {
  for (const Vector3d& asked : {Vector3d(3, 0, 0), Vector3d(std::nan(""), 0, 0), Vector3d(0, INFINITY, 0)}) {
    SafetyChain chain(10, 1e6, 1e-3);
    Vector3d force(0, 4, 0), torque(0.1, 0, 0);
    chain.apply(force, torque, true);
    double last = force.norm();
    for (int i = 0; i < 5; ++i) {
      force = asked;
      torque = Vector3d::Zero();
      EXPECT_TRUE(chain.apply(force, torque, i > 0) & fault);
      EXPECT_TRUE(force.allFinite());
      EXPECT_LT(force.norm(), last);
      last = force.norm();
    }
    EXPECT_LT(last, 1e-12);
    force = Vector3d(1, 0, 0);
    chain.apply(force, torque, true);
    EXPECT_LT(force.norm(), 1e-12);
  }
}

}  // namespace
}  // namespace palpate
