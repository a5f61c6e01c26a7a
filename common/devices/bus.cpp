#include <algorithm>
#include <atomic>
#include <cmath>

#include "common/devices/device.hpp"
#include "common/devices/lease.hpp"
#include "common/realtime/latest.hpp"
#include "common/tool/hand_motion.hpp"

namespace palpate {
namespace {

/// Passes on what comes as it is. Once its driver has been silent, the tool comes to where the driver is by then at a
/// hand's pace and without force.
class BusDevice : public Device {
 public:
  BusDevice(const BusDeviceSpec& spec, double haptic_hz)
      : lease_(spec.lease), scale_(spec.motion_scale), way_back_({.delay = kLead}, 1 / haptic_hz) {}

  DeviceSample read(double seconds) override {
    DeviceSample sample = newest_.get();
    for (double ToolDofs::*dof : {&ToolDofs::yaw, &ToolDofs::pitch, &ToolDofs::depth}) sample.dofs.*dof *= scale_;
    if (sample.seq != seq_) lease_.heard(seconds);
    seq_ = sample.seq;
    const bool over = lease_.over(seconds);
    if (over && !away_) way_back_.stand(at_);
    away_ |= over;
    if (away_) sample.dofs = come_back(sample.dofs, over);
    at_ = sample.dofs;
    return sample;
  }
  bool finished(double) const override { return false; }
  bool ready() const override { return ready_.load(std::memory_order_acquire); }
  bool on_bus() const override { return true; }
  void put(const DeviceSample& sample) override {
    newest_.put(sample);
    ready_.store(true, std::memory_order_release);
  }

 private:
  static constexpr double kLead = 0.005;                  ///< [s]
  static constexpr double kThere = 0.003, kTurned = 0.1;  ///< [m], [rad] near enough to be led on by the driver

  ToolDofs come_back(const ToolDofs& wanted, bool over) {
    if (over)
      way_back_.hold();
    else
      way_back_.aim(wanted);
    ToolDofs now = way_back_.step();
    const double tip = std::abs(wanted.depth) * (std::abs(now.yaw - wanted.yaw) + std::abs(now.pitch - wanted.pitch)) +
                       std::abs(now.depth - wanted.depth);
    const double turn = std::max(std::abs(now.roll - wanted.roll), std::abs(now.grip - wanted.grip));
    away_ = over || tip > kThere || turn > kTurned;
    if (over) now.pedal = 0;
    now.silent = away_;
    return now;
  }

  Lease lease_;
  double scale_;
  HandMotion way_back_;
  ToolDofs at_;
  std::uint64_t seq_ = 0;
  bool away_ = false;
  Latest<DeviceSample> newest_;
  std::atomic<bool> ready_{false};
};

}  // namespace

std::unique_ptr<Device> make_device(const BusDeviceSpec& spec, const DevicePlace& place) {
  return std::make_unique<BusDevice>(spec, place.haptic_hz);
}

}  // namespace palpate
