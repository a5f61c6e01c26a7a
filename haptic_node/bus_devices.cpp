#include "haptic_node/bus_devices.hpp"

#include "common/tool/motion_guard.hpp"

namespace palpate {

BusDevices::BusDevices(Bus& bus, std::vector<std::unique_ptr<Device>>& devices) {
  for (std::size_t t = 0; t < devices.size(); ++t)
    if (devices[t]->on_bus()) targets_.push_back({static_cast<std::uint32_t>(t), devices[t].get()});
  if (needed()) reader_ = bus.reader(topics::device_state);
}

bool BusDevices::needed() const {
  return !targets_.empty();
}

void BusDevices::take() {
  while (const auto sample = reader_->take()) {
    const ToolDofs dofs{sample->yaw, sample->pitch, sample->depth, sample->roll, sample->grip, sample->pedal};
    for (const Target& target : targets_) {
      if (target.tool != sample->tool) continue;
      if (MotionLimits{}.allow(dofs))
        target.device->put({dofs, sample->seq});
      else
        refused_.fetch_add(1, std::memory_order_relaxed);
    }
  }
}

}  // namespace palpate
