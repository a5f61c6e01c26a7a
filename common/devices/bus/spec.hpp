#pragma once
#include "common/devices/kind.hpp"

namespace palpate {

/// A driver elsewhere publishes the tool's motion.
struct BusDeviceSpec {
  static constexpr std::string_view kKind = "bus";
  static constexpr std::string_view kMeaning = "a driver elsewhere publishes it";
};

inline void describe(Description&, BusDeviceSpec&) {}

std::unique_ptr<Device> make_device(const BusDeviceSpec& spec, const DevicePlace& place);
inline std::filesystem::path motion_file(const BusDeviceSpec&) {
  return {};
}
std::optional<Trajectory> script(const BusDeviceSpec& spec);
constexpr std::string_view absence(const BusDeviceSpec&) {
  return "no tool on the bus: no device topic and no thread for it";
}

}  // namespace palpate
