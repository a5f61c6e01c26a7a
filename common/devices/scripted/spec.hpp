#pragma once
#include "common/devices/kind.hpp"

namespace palpate {

/// Moves a tool by a trajectory file.
struct ScriptedDeviceSpec {
  static constexpr std::string_view kKind = "scripted";
  static constexpr std::string_view kMeaning = "a trajectory file";
  std::filesystem::path trajectory;  ///< CSV
};

inline void describe(Description& d, ScriptedDeviceSpec& s) {
  d.file({"trajectory", "", "CSV for `\"scripted\"`, an LCM event log for `\"log\"`", Need::required, Use::local},
         s.trajectory);
}

std::unique_ptr<Device> make_device(const ScriptedDeviceSpec& spec, const DevicePlace& place);
inline std::filesystem::path motion_file(const ScriptedDeviceSpec& spec) {
  return spec.trajectory;
}
std::optional<Trajectory> script(const ScriptedDeviceSpec& spec);
constexpr std::string_view absence(const ScriptedDeviceSpec&) {
  return {};
}

}  // namespace palpate
