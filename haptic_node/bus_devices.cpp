#include "haptic_node/bus_devices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

#include "common/log/log.hpp"
#include "common/realtime/shutdown.hpp"
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
    const auto target = std::ranges::find(targets_, sample->tool, &Target::tool);
    if (target == targets_.end())
      say_unknown(sample->tool);
    else if (MotionLimits{}.allow(dofs))
      target->device->put({dofs, sample->seq});
    else
      refuse(sample->tool, dofs);
  }
}

void BusDevices::refuse(std::uint32_t tool, const ToolDofs& dofs) {
  if (refused_.fetch_add(1, std::memory_order_relaxed) > 0) return;
  log_warning(fmt::format(
      "a driver on topic {} puts tool {} where no tool can be, at yaw {:.4g}, pitch {:.4g}, depth {:.4g}, roll "
      "{:.4g}, grip {:.4g}: in rad and m they are up to {} and {} either way; such samples are not heard",
      topics::device_state.name, tool, dofs.yaw, dofs.pitch, dofs.depth, dofs.roll, dofs.grip, MotionLimits::kMaxAngle,
      MotionLimits::kMaxDepth));
}

void BusDevices::say_unknown(std::uint32_t tool) {
  if (std::exchange(said_unknown_, true)) return;
  log_warning(
      fmt::format("a driver on topic {} moves tool {}, which no driver elsewhere moves in this scene; it is not heard",
                  topics::device_state.name, tool));
}

void wait_for_devices(std::vector<std::unique_ptr<Device>>& devices, Bus& bus, double seconds) {
  BusDevices drivers(bus, devices);
  const auto all_ready = [&] { return std::ranges::all_of(devices, [](const auto& d) { return d->ready(); }); };
  if (!all_ready()) log_info(fmt::format("waiting for a driver on topic {}", topics::device_state.name));
  const auto begin = std::chrono::steady_clock::now();
  while (!all_ready() && !shutdown_requested()) {
    if (seconds > 0 && std::chrono::steady_clock::now() - begin > std::chrono::duration<double>(seconds))
      throw std::runtime_error(
          fmt::format("no driver on topic {} has spoken for {} s{}", topics::device_state.name, seconds,
                      drivers.refused() > 0 ? fmt::format(": {} samples were not heard", drivers.refused()) : ""));
    std::this_thread::sleep_for(std::chrono::microseconds(250));
    drivers.take();
  }
}

}  // namespace palpate
