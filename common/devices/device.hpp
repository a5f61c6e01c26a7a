#pragma once
#include <memory>
#include <span>
#include <vector>

#include "common/tool/device_sample.hpp"
#include "common/tool/spec.hpp"

namespace palpate {

/// What the hand gets at the tool's tip, world frame.
struct Wrench {
  Eigen::Vector3d force;   ///< [N] on the tool
  Eigen::Vector3d torque;  ///< [N m] on the tool, about its tip
};

/// What one tool's degrees of freedom come from, and its force goes to.
class Device {
 public:
  virtual ~Device() = default;
  /// Pose at a time [s] since the loop began. Called in the haptic step: no allocation, no lock, no I/O.
  virtual DeviceSample read(double seconds) = 0;
  /// The force of the step that used the last read(), and the torque [N m] on the handle, which opens the jaws. Called
  /// in the same tick: no allocation, no lock, no I/O. What has no motors takes no notice.
  virtual void render(const Wrench& /*wrench*/, double /*grip*/) {}
  /// True when a recorded or scripted motion is over.
  virtual bool finished(double seconds) const = 0;
  /// False until the first pose is known (a driver elsewhere has not spoken yet).
  virtual bool ready() const { return true; }
  /// Whether its samples come from a driver elsewhere, by put(), which is called on a thread of its own.
  virtual bool on_bus() const { return false; }
  virtual void put(const DeviceSample&) {}
};

/// The tool that a device moves.
struct DevicePlace {
  const Tool& tool;
  std::uint32_t index;  ///< position in the scene's tool list
  double haptic_hz;
};

/// The devices that a scene names for its tools, one each; with `hands` people may take them, unless they are theirs
/// anyway or their driver is elsewhere. Throws std::runtime_error for a missing or malformed file.
std::vector<std::unique_ptr<Device>> make_devices(std::span<const Tool> tools, double haptic_hz, bool hands = false);

}  // namespace palpate
