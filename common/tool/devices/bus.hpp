#pragma once
#include "common/tool/devices/kind.hpp"

namespace palpate {

/// A driver elsewhere publishes the tool's motion.
struct BusDeviceSpec {
  static constexpr std::string_view kKind = "bus";
  static constexpr std::string_view kMeaning = "a driver elsewhere publishes it";

  double lease = 0.1;
  double motion_scale = 1;  ///< [1] of the driver's yaw, pitch and depth, about the trocar, that the tool does
};

inline void describe(Description& d, BusDeviceSpec& b) {
  describe_lease(d, b.lease);
  d.number({"motion_scale", "",
            "what the driver says of yaw, pitch and depth is multiplied by it: 0.5 halves the motion about the trocar",
            Need::optional, Use::local},
           b.motion_scale, within(1e-3, 1e3));
}

std::unique_ptr<Device> make_device(const BusDeviceSpec& spec, const DevicePlace& place);
inline std::filesystem::path motion_file(const BusDeviceSpec&) {
  return {};
}
inline std::optional<Trajectory> script(const BusDeviceSpec&) {
  return {};
}
constexpr ForHands for_hands(const BusDeviceSpec&) {
  return ForHands::never;
}
constexpr std::string_view absence(const BusDeviceSpec&) {
  return kNoDriverElsewhere;
}

}  // namespace palpate
