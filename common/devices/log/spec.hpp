#pragma once
#include "common/devices/kind.hpp"

namespace palpate {

/// Moves a tool as it moved in a recorded log.
struct LogDeviceSpec {
  static constexpr std::string_view kKind = "log";
  static constexpr std::string_view kMeaning = "the tool's motion in a recorded log";
  std::filesystem::path trajectory;  ///< LCM event log
};

inline void describe(Description& d, LogDeviceSpec& l) {
  d.file({"trajectory", "", "CSV for `\"scripted\"`, an LCM event log for `\"log\"`", Need::required, Use::local},
         l.trajectory);
}

std::unique_ptr<Device> make_device(const LogDeviceSpec& spec, const DevicePlace& place);
inline std::filesystem::path motion_file(const LogDeviceSpec& spec) {
  return spec.trajectory;
}
std::optional<Trajectory> script(const LogDeviceSpec& spec);
constexpr std::string_view absence(const LogDeviceSpec&) {
  return {};
}

}  // namespace palpate
