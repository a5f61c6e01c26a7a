#include "common/devices/held_device.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {

std::unique_ptr<Device> make_device(const PointerDeviceSpec& spec, const DevicePlace& place) {
  HeldDevice::Settings settings;
  settings.bounds.delay = spec.delay;
  settings.bounds.speed = spec.max_speed;
  settings.lease = spec.lease;
  const Tool& tool = place.tool;
  const ToolDofs start = dofs_for_tip(make_trocar(tool.pivot, tool.axis, tool.up), spec.start, 0);
  return std::make_unique<HeldDevice>(settings, place, start);
}

}  // namespace palpate
