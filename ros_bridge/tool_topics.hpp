#pragma once
#include <Eigen/Geometry>
#include <cstdint>

#include "common/tool/kinematics.hpp"
#include "common/tool/spec.hpp"
#include "idl/messages.hpp"
#include "ros_bridge/ros_node.hpp"

namespace palpate::ros {

/// The frame of every scene's coordinates.
inline constexpr const char* kWorld = "world";

/// What ROS sees of one tool: its tip's pose and its joints, the frame NAME_tip on /tf, whose origin is the tip and
/// whose z axis points along the shaft away from the hand, and, in that frame, the wrench *on the tool* about its tip.
class ToolTopics {
 public:
  ToolTopics(Node& node, const Tool& tool);

  /// /palpate/NAME/pose, /palpate/NAME/joint_states (yaw, pitch, roll, grip [rad], depth [m]) and /tf.
  /// `wall_ns`: when the tool was read, CLOCK_REALTIME.
  void tell(const ToolState& state, std::int64_t wall_ns);
  /// /palpate/NAME/wrench [N, N m], by the pose told last; nothing before the first.
  void tell(const ForceState& force, std::int64_t wall_ns);

 private:
  Trocar trocar_;
  std::string tip_frame_;
  PlainWriter pose_, joints_, wrench_, frames_;
  Eigen::Matrix3d to_tip_ = Eigen::Matrix3d::Zero();  ///< from world; zero: no pose yet
};

}  // namespace palpate::ros
