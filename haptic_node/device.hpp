#pragma once
#include <memory>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/scene/scene.hpp"
#include "common/sim/step_record.hpp"

namespace palpate {

/// Where one tool's degrees of freedom come from.
class Device {
 public:
  virtual ~Device() = default;
  /// Pose at a time [s] since the loop began. Called in the haptic step: no allocation, no lock, no I/O.
  virtual DeviceSample read(double seconds) = 0;
  /// True when a recorded or scripted motion is over.
  virtual bool finished(double seconds) const = 0;
  /// False until the first pose is known (a driver elsewhere has not spoken yet).
  virtual bool ready() const { return true; }
};

/// The tool that a device moves.
struct DevicePlace {
  const Tool& tool;
  std::uint32_t index;  ///< position in the scene's tool list
  double haptic_hz;
};

/// The device that the scene names for this tool. Throws std::runtime_error for a missing or malformed file.
std::unique_ptr<Device> make_device(const Scene& scene, int tool);

/// Moves samples of drivers elsewhere from the bus to their tools; runs on a thread of its own, not in the step.
class BusDevices {
 public:
  BusDevices(Bus& bus, std::vector<std::unique_ptr<Device>>& devices);
  ~BusDevices();
  /// Takes what has come.
  void take();
  bool needed() const;  ///< some tool waits for a driver elsewhere

 private:
  struct Target;
  std::unique_ptr<Reader<DeviceState>> reader_;
  std::vector<Target> targets_;
};

}  // namespace palpate
