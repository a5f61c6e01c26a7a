#pragma once
#include <Eigen/Core>

#include "common/tool/devices/kind.hpp"

namespace palpate {

/// People move the tool in the live view, by mouse, touch or gamepad.
struct PointerDeviceSpec {
  static constexpr std::string_view kKind = "pointer";
  static constexpr std::string_view kMeaning = "people move it in the live view";

  Eigen::Vector3d start{0, 0, 0};
  double lease = 0.1;
  double delay = 0.02;
  double max_speed = 0.25;
};

inline void describe(Description& d, PointerDeviceSpec& p) {
  d.vector({"start", "m", "where the tip stands until somebody takes the tool", Need::required, Use::local}, p.start);
  describe_lease(d, p.lease);
  d.number(
      {"delay", "s", "over which a sample is led up to, longer than samples are apart", Need::optional, Use::local},
      p.delay, within(0.001, 1));
  d.number({"max_speed", "m/s", "of the tip", Need::optional, Use::local}, p.max_speed, within(0.001, 2));
}

std::unique_ptr<Device> make_device(const PointerDeviceSpec& spec, const DevicePlace& place);
inline std::filesystem::path motion_file(const PointerDeviceSpec&) {
  return {};
}
inline std::optional<Trajectory> script(const PointerDeviceSpec&) {
  return {};
}
constexpr ForHands for_hands(const PointerDeviceSpec&) {
  return ForHands::always;
}
constexpr std::string_view absence(const PointerDeviceSpec&) {
  return kNoDriverElsewhere;
}

}  // namespace palpate
