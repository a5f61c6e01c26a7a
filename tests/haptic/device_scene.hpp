#pragma once
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

}  // namespace palpate::testing
