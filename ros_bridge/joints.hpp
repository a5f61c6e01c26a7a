#pragma once
#include <array>
#include <string>

#include "idl/messages.hpp"
#include "ros_messages.h"

namespace palpate::ros {

/// A tool's degrees of freedom as joints, in the order in which they are told; a command may also name "pedal".
inline constexpr std::array kJoints{"yaw", "pitch", "depth", "roll", "grip"};

/// Sets the joints that a command names, and leaves the others. A sentence about what is wrong with it, and then
/// nothing is set; empty: it is right.
std::string follow(const sensor_msgs_msg_dds__JointState_& command, DeviceState& state);

}  // namespace palpate::ros
