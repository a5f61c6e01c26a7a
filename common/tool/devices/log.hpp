#pragma once
#include "common/tool/devices/motion_file.hpp"

namespace palpate {

/// Moves a tool as it moved in a recorded log (LCM events).
struct LogDeviceSpec : MotionFileSpec {
  static constexpr std::string_view kKind = "log";
  static constexpr std::string_view kMeaning = "the tool's motion in a recorded log";
};

std::unique_ptr<Device> make_device(const LogDeviceSpec& spec, const DevicePlace& place);
inline std::optional<Trajectory> script(const LogDeviceSpec&) {
  return {};
}

}  // namespace palpate
