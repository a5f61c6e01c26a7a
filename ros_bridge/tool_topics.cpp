#include "ros_bridge/tool_topics.hpp"

#include <algorithm>

#include "common/tool/dofs_of.hpp"
#include "ros_bridge/convert.hpp"
#include "ros_bridge/joints.hpp"

namespace palpate::ros {
namespace {

std::string topic(const Tool& tool, const char* what) {
  return "/palpate/" + allowed_name(tool.name) + "/" + what;
}

}  // namespace

ToolTopics::ToolTopics(Node& node, const Tool& tool)
    : trocar_(make_trocar(tool.pivot, tool.axis, tool.up)),
      tip_frame_(allowed_name(tool.name) + "_tip"),
      pose_(node.publisher(topic(tool, "pose"), geometry_msgs_msg_dds__PoseStamped__desc)),
      joints_(node.publisher(topic(tool, "joint_states"), sensor_msgs_msg_dds__JointState__desc)),
      wrench_(node.publisher(topic(tool, "wrench"), geometry_msgs_msg_dds__WrenchStamped__desc)),
      frames_(node.publisher("/tf", tf2_msgs_msg_dds__TFMessage__desc)) {}

void ToolTopics::tell(const ToolState& state, std::int64_t wall_ns) {
  const Eigen::Isometry3d tip = tip_pose(trocar_, dofs_of(state));
  to_tip_ = tip.linear().transpose();
  geometry_msgs_msg_dds__PoseStamped_ pose{};
  pose.header = header(wall_ns, kWorld);
  pose.pose.position = {tip.translation().x(), tip.translation().y(), tip.translation().z()};
  pose.pose.orientation = quaternion(tip.linear());
  pose_.write(&pose);

  geometry_msgs_msg_dds__TransformStamped_ to_world{};
  to_world.header = pose.header;
  to_world.child_frame_id = lend(tip_frame_);
  to_world.transform = {vector3(tip.translation()), pose.pose.orientation};
  tf2_msgs_msg_dds__TFMessage_ frames{};
  frames.transforms = {._maximum = 1, ._length = 1, ._buffer = &to_world, ._release = false};
  frames_.write(&frames);

  std::vector<char*> names(kJoints.size());
  std::ranges::transform(kJoints, names.begin(), [](const char* name) { return lend(name); });
  const PoseValues values = pose_values(state);
  std::vector<double> positions(values.begin(), values.end());
  sensor_msgs_msg_dds__JointState_ joints{};
  joints.header = header(wall_ns, "");
  lend(names, joints.name);
  lend(positions, joints.position);
  joints_.write(&joints);
}

void ToolTopics::tell(const ForceState& force, std::int64_t wall_ns) {
  if (to_tip_.isZero()) return;
  geometry_msgs_msg_dds__WrenchStamped_ wrench{};
  wrench.header = header(wall_ns, tip_frame_.c_str());
  wrench.wrench.force = vector3(to_tip_ * Eigen::Vector3d(force.force.data()));
  wrench.wrench.torque = vector3(to_tip_ * Eigen::Vector3d(force.torque.data()));
  wrench_.write(&wrench);
}

}  // namespace palpate::ros
