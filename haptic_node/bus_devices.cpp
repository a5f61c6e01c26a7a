#include "haptic_node/bus_devices.hpp"

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
  while (const auto sample = reader_->take())
    for (const Target& target : targets_)
      if (target.tool == sample->tool)
        target.device->put(
            {{sample->yaw, sample->pitch, sample->depth, sample->roll, sample->grip, sample->pedal}, sample->seq});
}

}  // namespace palpate
