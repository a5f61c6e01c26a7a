#include "common/tool/port.hpp"

namespace palpate {

PortMotion motion_between(const Eigen::Isometry3d& before, const Eigen::Isometry3d& now, double opening) {
  const Eigen::Matrix3d turn = now.linear() * before.linear().transpose();
  // Twice the sine of the angle along the axis: for the small turn of a tick, the rotation vector to third order.
  const Eigen::Vector3d twice(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
  return {now.translation() - before.translation(), 0.5 * twice, opening};
}

}  // namespace palpate
