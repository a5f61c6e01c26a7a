#pragma once
#include <Eigen/Geometry>
#include <cstdint>

#include "ros_bridge/lend.hpp"

/// Values as ROS's messages have them; SI units on both sides.
namespace palpate::ros {

/// `wall_ns`: since 1970. The frame's name is lent.
std_msgs_msg_dds__Header_ header(std::int64_t wall_ns, const char* frame);
geometry_msgs_msg_dds__Vector3_ vector3(const Eigen::Vector3d& v);
geometry_msgs_msg_dds__Quaternion_ quaternion(const Eigen::Matrix3d& rotation);

}  // namespace palpate::ros
