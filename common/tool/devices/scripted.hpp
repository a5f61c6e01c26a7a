#pragma once
#include "common/tool/devices/motion_file.hpp"

namespace palpate {

/// Moves a tool by a trajectory file (CSV).
struct ScriptedDeviceSpec : MotionFileSpec {
  static constexpr std::string_view kKind = "scripted";
  static constexpr std::string_view kMeaning = "a trajectory file";
};

std::unique_ptr<Device> make_device(const ScriptedDeviceSpec& spec, const DevicePlace& place);

}  // namespace palpate
