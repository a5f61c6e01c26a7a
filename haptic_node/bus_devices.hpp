#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/devices/device.hpp"

namespace palpate {

/// Moves samples of drivers elsewhere from the bus to their tools; runs on a thread of its own, not in the step.
class BusDevices {
 public:
  BusDevices(Bus& bus, std::vector<std::unique_ptr<Device>>& devices);
  /// Takes what has come.
  void take();
  bool needed() const;  ///< some tool waits for a driver elsewhere
  std::uint64_t refused() const { return refused_.load(std::memory_order_relaxed); }  ///< samples of no possible pose

 private:
  struct Target {
    std::uint32_t tool;
    Device* device;
  };
  void say_unknown(std::uint32_t tool);
  void refuse(std::uint32_t tool, const ToolDofs& dofs);

  std::unique_ptr<Reader<DeviceState>> reader_;
  std::vector<Target> targets_;
  std::atomic<std::uint64_t> refused_ = 0;
  bool said_unknown_ = false;
};

/// Waits until every driver elsewhere has spoken, saying once that it waits. Throws std::runtime_error if one has not
/// after `seconds`; 0: there is no limit.
void wait_for_devices(std::vector<std::unique_ptr<Device>>& devices, Bus& bus, double seconds);

}  // namespace palpate
