#pragma once
#include <Eigen/Geometry>

namespace palpate {

/// What the hand gets of one tool at its tip, world frame, and at its handle.
struct PortForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N] on the tool
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m] on the tool
  double grip = 0;                                   ///< [N m] on the handle, opens the jaws
};

/// How one tool moved from the last tick to this one.
struct PortMotion {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< [m] of the tip
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();   ///< [rad] rotation vector
  double opening = 0;                               ///< [rad] of the handle
};

/// The motion between two poses of the tip frame.
PortMotion motion_between(const Eigen::Isometry3d& before, const Eigen::Isometry3d& now, double opening);

}  // namespace palpate
