#pragma once
#include <variant>

#include "common/tool/devices/bus.hpp"
#include "common/tool/devices/hand.hpp"
#include "common/tool/devices/log.hpp"
#include "common/tool/devices/pointer.hpp"
#include "common/tool/devices/scripted.hpp"

namespace palpate {

/// The table of devices: a tool has one of them.
using DeviceSpec = std::variant<ScriptedDeviceSpec, LogDeviceSpec, BusDeviceSpec, PointerDeviceSpec, HandDeviceSpec>;

/// As a scene file writes it: `scripted`.
inline std::string_view kind_of(const DeviceSpec& device) {
  return std::visit([](const auto& spec) { return spec.kKind; }, device);
}

inline std::filesystem::path motion_file_of(const DeviceSpec& device) {
  return std::visit([](const auto& spec) { return motion_file(spec); }, device);
}

/// Whether a person may take the tool; `asked`: also one that follows a file.
inline bool is_for_hands(const DeviceSpec& device, bool asked) {
  const ForHands taken = std::visit([](const auto& spec) { return for_hands(spec); }, device);
  return taken == ForHands::always || (asked && taken == ForHands::if_asked);
}

/// Empty where the motion is not known before the run.
inline std::optional<Trajectory> script_of(const DeviceSpec& device) {
  return std::visit([](const auto& spec) { return script(spec); }, device);
}

}  // namespace palpate
