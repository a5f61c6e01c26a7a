#include "common/tool/kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace palpate {

namespace {

/// Yaw about y, then pitch about the new x: turns the trocar's frame so that z lies along the shaft.
Eigen::Matrix3d swing(const ToolDofs& dofs) {
  return (Eigen::AngleAxisd(dofs.yaw, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(dofs.pitch, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace

Trocar make_trocar(const Eigen::Vector3d& pivot, const Eigen::Vector3d& axis, const Eigen::Vector3d& up) {
  const Eigen::Vector3d z = axis.stableNormalized();
  const Eigen::Vector3d x = up.stableNormalized().cross(z);
  if (!(x.norm() > 1e-9)) throw std::runtime_error("a tool's axis and up must be two different directions, not zero");
  Trocar trocar;
  trocar.pivot = pivot;
  trocar.frame.col(0) = x.normalized();
  trocar.frame.col(1) = z.cross(x).normalized();
  trocar.frame.col(2) = z;
  return trocar;
}

Eigen::Isometry3d tip_pose(const Trocar& trocar, const ToolDofs& dofs) {
  const Eigen::Matrix3d shaft = trocar.frame * swing(dofs);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = shaft * Eigen::AngleAxisd(dofs.roll, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = trocar.pivot + dofs.depth * shaft.col(2);
  return pose;
}

ToolDofs dofs_for_tip(const Trocar& trocar, const Eigen::Vector3d& tip, double roll) {
  // The shaft's direction in the trocar's frame is (sin yaw cos pitch, -sin pitch, cos yaw cos pitch).
  const Eigen::Vector3d d = trocar.frame.transpose() * (tip - trocar.pivot);
  ToolDofs dofs;
  dofs.depth = d.norm();
  dofs.yaw = std::atan2(d.x(), d.z());
  dofs.pitch = std::atan2(-d.y(), std::hypot(d.x(), d.z()));
  dofs.roll = roll;
  return dofs;
}

Eigen::Vector4d generalised_force(const Trocar& trocar, const ToolDofs& dofs, const Eigen::Vector3d& force,
                                  const Eigen::Vector3d& torque) {
  const Eigen::Matrix3d shaft = trocar.frame * swing(dofs);
  const Eigen::Vector3d moment = torque + (dofs.depth * shaft.col(2)).cross(force);  // about the pivot
  return {trocar.frame.col(1).dot(moment), shaft.col(0).dot(moment), shaft.col(2).dot(force), shaft.col(2).dot(torque)};
}

LeverForces trocar_reaction(const Trocar& trocar, const ToolDofs& dofs, double shaft_length,
                            const Eigen::Vector3d& force, const Eigen::Vector3d& torque) {
  const Eigen::Vector3d along = (trocar.frame * swing(dofs)).col(2);
  const Eigen::Vector3d moment = torque + dofs.depth * along.cross(force);  // about the pivot
  const double handle = shaft_length - dofs.depth;                          // [m] behind the pivot
  LeverForces lever;
  const Eigen::Vector3d across = -along.cross(moment) / std::max(handle, kMinLever);
  lever.hand = across - along.dot(force) * along;
  lever.trocar = -(force - along.dot(force) * along) - across;
  lever.twist = handle * along.cross(across) - moment;
  return lever;
}

}  // namespace palpate
