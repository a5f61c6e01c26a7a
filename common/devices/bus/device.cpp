#include "common/devices/device.hpp"

#include <atomic>

#include "common/realtime/latest.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {
namespace {

class BusDevice : public Device {
 public:
  DeviceSample read(double) override { return newest_.get(); }
  bool finished(double) const override { return false; }
  bool ready() const override { return ready_.load(std::memory_order_acquire); }
  bool on_bus() const override { return true; }
  void put(const DeviceSample& sample) override {
    newest_.put(sample);
    ready_.store(true, std::memory_order_release);
  }

 private:
  Latest<DeviceSample> newest_;
  std::atomic<bool> ready_{false};
};

}  // namespace

std::unique_ptr<Device> make_device(const BusDeviceSpec&, const DevicePlace&) {
  return std::make_unique<BusDevice>();
}

std::optional<Trajectory> script(const BusDeviceSpec&) {
  return {};
}

}  // namespace palpate
