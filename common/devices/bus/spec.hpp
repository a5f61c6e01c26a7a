#pragma once
#include "common/devices/kind.hpp"

namespace palpate {

/// A driver elsewhere publishes the tool's motion.
struct BusDeviceSpec {
  static constexpr std::string_view kKind = "bus";
  static constexpr std::string_view kMeaning = "a driver elsewhere publishes it";

  double lease = 0.1;
};

inline void describe(Description& d, BusDeviceSpec& b) {
  describe_lease(d, b.lease);
}

std::unique_ptr<Device> make_device(const BusDeviceSpec& spec, const DevicePlace& place);
inline std::filesystem::path motion_file(const BusDeviceSpec&) {
  return {};
}
std::optional<Trajectory> script(const BusDeviceSpec& spec);
constexpr ForHands for_hands(const BusDeviceSpec&) {
  return ForHands::never;
}
constexpr std::string_view absence(const BusDeviceSpec&) {
  return kNoDriverElsewhere;
}

}  // namespace palpate
