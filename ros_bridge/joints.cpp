#include "ros_bridge/joints.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "common/describe/printable.hpp"

namespace palpate::ros {
namespace {

double DeviceState::*joint(const std::string& name) {
  static const std::map<std::string, double DeviceState::*> all{
      {"yaw", &DeviceState::yaw},   {"pitch", &DeviceState::pitch}, {"depth", &DeviceState::depth},
      {"roll", &DeviceState::roll}, {"grip", &DeviceState::grip},   {"pedal", &DeviceState::pedal}};
  const auto found = all.find(name);
  return found == all.end() ? nullptr : found->second;
}

}  // namespace

std::string follow(const sensor_msgs_msg_dds__JointState_& command, DeviceState& state) {
  if (command.name._length == 0 || command.name._length != command.position._length)
    return fmt::format("it has {} names and {} positions", command.name._length, command.position._length);
  DeviceState wanted = state;
  for (std::uint32_t i = 0; i < command.name._length; ++i) {
    const std::string name = command.name._buffer[i];
    const auto member = joint(name);
    if (!member) return fmt::format("'{}' is no joint of a tool", printable(name.substr(0, 40)));
    if (!std::isfinite(command.position._buffer[i])) return fmt::format("the position of '{}' is no number", name);
    wanted.*member = command.position._buffer[i];
  }
  state = wanted;
  return {};
}

}  // namespace palpate::ros
