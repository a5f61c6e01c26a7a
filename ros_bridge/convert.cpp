#include "ros_bridge/convert.hpp"

#include "common/realtime/clock.hpp"

namespace palpate::ros {

std_msgs_msg_dds__Header_ header(std::int64_t wall_ns, const char* frame) {
  std_msgs_msg_dds__Header_ header{};
  header.stamp.sec = static_cast<std::int32_t>(wall_ns / kNsPerS);
  header.stamp.nanosec = static_cast<std::uint32_t>(wall_ns % kNsPerS);
  header.frame_id = lend(frame);
  return header;
}

geometry_msgs_msg_dds__Vector3_ vector3(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

geometry_msgs_msg_dds__Quaternion_ quaternion(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return {q.x(), q.y(), q.z(), q.w()};
}

}  // namespace palpate::ros
