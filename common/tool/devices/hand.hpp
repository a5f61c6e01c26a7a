#pragma once
#include "common/tool/devices/motion_file.hpp"

namespace palpate {

/// An emulated hand leads the tool along a trajectory file and gives way to the force. By default the hand that van
/// Beek et al., Scientific Reports 5:18004, 2015, measured on its device.
struct HandDeviceSpec : MotionFileSpec {
  static constexpr std::string_view kKind = "hand";
  static constexpr std::string_view kMeaning =
      "an emulated hand, which wants to follow a trajectory file and gives way to the force";

  double mass = 0.554;
  double damping = 6.45;
  double stiffness = 135;
};

inline void describe(Description& d, HandDeviceSpec& h) {
  describe(d, static_cast<MotionFileSpec&>(h));
  d.number({"mass", "kg", "of the hand and its device", Need::optional, Use::local}, h.mass, within(0.01, 10));
  d.number({"damping", "N s/m", "of the hand's grip", Need::optional, Use::local}, h.damping, within(0, 100));
  d.number(
      {"stiffness", "N/m", "of the hand's grip, towards where the trajectory has the tip", Need::optional, Use::local},
      h.stiffness, within(1, 10'000));
}

std::unique_ptr<Device> make_device(const HandDeviceSpec& spec, const DevicePlace& place);

}  // namespace palpate
