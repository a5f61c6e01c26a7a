#include "common/geometry/direction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector3d;

TEST(Direction, TheTurnBetweenTwoTakesOneIntoTheOther) {
  const Vector3d from(0.3, -1.2, 0.5);
  for (const Vector3d& to : {Vector3d(2, 0.1, 0), Vector3d(0.3, -1.2, 0.5), Vector3d(-0.3, 1.2, -0.501),
                             Vector3d(-3, 12, -5), Vector3d(0, 0, 1e-3)}) {
    const Eigen::Quaterniond turn = turn_between(from, to);
    EXPECT_NEAR(turn.norm(), 1, 1e-9);
    EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-9) << to.transpose();
    EXPECT_NEAR(Eigen::AngleAxisd(turn).angle(),
                std::acos(std::clamp(from.normalized().dot(to.normalized()), -1.0, 1.0)), 1e-7);
  }
}

}  // namespace
}  // namespace palpate
