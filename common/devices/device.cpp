#include "common/devices/device.hpp"

#include "common/tool/trajectory.hpp"

namespace palpate {

std::unique_ptr<Device> make_device(const Scene& scene, int tool) {
  const DevicePlace place{scene.tools[tool], static_cast<std::uint32_t>(tool), scene.rates.haptic_hz};
  return std::visit([&](const auto& spec) { return make_device(spec, place); }, place.tool.device);
}

std::optional<Trajectory> script_of(const DeviceSpec& device) {
  return std::visit([](const auto& spec) { return script(spec); }, device);
}

}  // namespace palpate
