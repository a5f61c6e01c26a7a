#pragma once
#include "common/devices/device.hpp"
#include "common/scene/scene.hpp"

namespace palpate::testing {

/// Of one tool, named probe, with that device.
inline Scene scene_with(const DeviceSpec& device) {
  Scene scene;
  Tool tool;
  tool.name = "probe";
  tool.device = device;
  scene.tools.push_back(tool);
  return scene;
}

inline std::unique_ptr<Device> device_with(const DeviceSpec& spec) {
  const Scene scene = scene_with(spec);
  return std::move(make_devices(scene.tools, scene.rates.haptic_hz).front());
}

}  // namespace palpate::testing
