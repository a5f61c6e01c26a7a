#include "common/devices/device.hpp"

#include "common/devices/held_device.hpp"

namespace palpate {
namespace {

std::unique_ptr<Device> make(const DevicePlace& place, bool hands) {
  auto device = std::visit([&](const auto& spec) { return make_device(spec, place); }, place.tool.device);
  if (device->on_bus() || !is_for_hands(place.tool.device, hands)) return device;
  return std::make_unique<HeldDevice>(HeldDevice::Settings{}, place, std::move(device));
}

}  // namespace

std::vector<std::unique_ptr<Device>> make_devices(std::span<const Tool> tools, double haptic_hz, bool hands) {
  std::vector<std::unique_ptr<Device>> devices;
  for (const Tool& tool : tools)
    devices.push_back(make({tool, static_cast<std::uint32_t>(devices.size()), haptic_hz}, hands));
  return devices;
}

}  // namespace palpate
