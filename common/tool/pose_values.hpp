#pragma once
#include <array>

#include "common/tool/kinematics.hpp"

namespace palpate {

/// Yaw, pitch, depth, roll and grip, as in ToolDofs: [rad, rad, m, rad, rad].
using PoseValues = std::array<double, 5>;

/// Of whatever has members of these names: ToolDofs, and the messages that hold a tool's pose.
template <class Pose>
PoseValues pose_values(const Pose& pose) {
  return {pose.yaw, pose.pitch, pose.depth, pose.roll, pose.grip};
}
template <class Pose>
void set_pose(const PoseValues& values, Pose& pose) {
  pose.yaw = values[0], pose.pitch = values[1], pose.depth = values[2], pose.roll = values[3], pose.grip = values[4];
}

inline ToolDofs dofs_of(const PoseValues& values, double pedal = 0) {
  ToolDofs dofs;
  set_pose(values, dofs);
  dofs.pedal = pedal;
  return dofs;
}

}  // namespace palpate
