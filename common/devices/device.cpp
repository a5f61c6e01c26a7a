#include "common/devices/device.hpp"

#include "common/devices/held_device.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {

std::unique_ptr<Device> make_device(const Scene& scene, int tool, bool hands) {
  const DevicePlace place{scene.tools[tool], static_cast<std::uint32_t>(tool), scene.rates.haptic_hz};
  auto device = std::visit([&](const auto& spec) { return make_device(spec, place); }, place.tool.device);
  if (device->on_bus() || !is_for_hands(place.tool.device, hands)) return device;
  return std::make_unique<HeldDevice>(HeldDevice::Settings{}, place, std::move(device));
}

std::optional<Trajectory> script_of(const DeviceSpec& device) {
  return std::visit([](const auto& spec) { return script(spec); }, device);
}

}  // namespace palpate
