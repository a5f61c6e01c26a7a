#pragma once
#include <Eigen/Geometry>

namespace palpate {

/// The five degrees of freedom of an instrument about its trocar, and its pedal.
struct ToolDofs {
  double yaw = 0;       ///< [rad] about the zero pose's y axis (up), positive by the right-hand rule
  double pitch = 0;     ///< [rad] about the yawed x axis, positive by the right-hand rule
  double depth = 0;     ///< [m] from the trocar to the tip's centre, along the shaft
  double roll = 0;      ///< [rad] about the shaft, from handle to tip
  double grip = 0;      ///< [rad] jaw opening
  double pedal = 0;     ///< [-] 1 while the tool's pedal is down (cautery on), 0 while it is up
  bool silent = false;  ///< its driver elsewhere has let go: the tool stands, and its force fades
};

/// Fixed frame of the trocar: origin at the pivot, z along the zero pose's shaft (handle to tip), y up.
struct Trocar {
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  ///< columns x, y, z in world coordinates
};

/// `axis` and `up` as in the scene; up is made perpendicular to axis. Throws if they are parallel or zero.
Trocar make_trocar(const Eigen::Vector3d& pivot, const Eigen::Vector3d& axis, const Eigen::Vector3d& up);

/// Pose of the tip frame in the world: origin at the tip's centre, z along the shaft (handle to tip).
Eigen::Isometry3d tip_pose(const Trocar& trocar, const ToolDofs& dofs);

/// The dofs (grip and pedal excluded) that put the tip's centre at a world point, with the given roll; inverse of
/// tip_pose.
ToolDofs dofs_for_tip(const Trocar& trocar, const Eigen::Vector3d& tip, double roll);

/// Force and torque [N, N m] on the tool at its tip as generalised forces along yaw, pitch, depth, roll
/// [N m, N m, N, N m], by virtual work: what motors at the trocar give to the tool.
Eigen::Vector4d generalised_force(const Trocar& trocar, const ToolDofs& dofs, const Eigen::Vector3d& force,
                                  const Eigen::Vector3d& torque);

/// What holds an instrument against a force at its tip: the trocar, which is a frictionless pivot and bears on the
/// shaft from the side alone, and the hand at the handle's end. World frame.
struct LeverForces {
  Eigen::Vector3d trocar = Eigen::Vector3d::Zero();  ///< [N] of the trocar on the shaft, across it
  Eigen::Vector3d hand = Eigen::Vector3d::Zero();    ///< [N] of the hand on the handle's end
  Eigen::Vector3d twist = Eigen::Vector3d::Zero();   ///< [N m] of the hand: along the shaft, against its roll
};

/// The hand's lever is at least this long [m]: a handle that has come to the trocar could not bear a moment.
inline constexpr double kMinLever = 0.01;

/// The reaction to force and torque [N, N m] on the tool at its tip (about the tip's origin): all forces and all
/// moments sum to zero. The handle's end lies shaft_length [m] behind the tip; nearer to the trocar than min_lever,
/// the hand's force is that of this lever and `twist` takes the rest of the moment.
LeverForces trocar_reaction(const Trocar& trocar, const ToolDofs& dofs, double shaft_length,
                            const Eigen::Vector3d& force, const Eigen::Vector3d& torque);

}  // namespace palpate
