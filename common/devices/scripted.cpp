#include "common/devices/device.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {
namespace {

class ScriptedDevice : public Device {
 public:
  ScriptedDevice(const std::filesystem::path& file, const Tool& tool) : trajectory_(load_trajectory(file)) {
    check_grip(trajectory_, file, tool);
  }
  DeviceSample read(double seconds) override { return {trajectory_.at(seconds), 0}; }
  bool finished(double seconds) const override { return seconds > trajectory_.duration(); }

 private:
  Trajectory trajectory_;
};

}  // namespace

std::unique_ptr<Device> make_device(const ScriptedDeviceSpec& spec, const DevicePlace& place) {
  return std::make_unique<ScriptedDevice>(spec.trajectory, place.tool);
}

}  // namespace palpate
