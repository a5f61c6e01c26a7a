#pragma once
#include "common/devices/device.hpp"
#include "common/devices/lease.hpp"
#include "common/realtime/latest.hpp"
#include "common/tool/hand_motion.hpp"

namespace palpate {

/// A tool that people may take, by samples of some sixty a second from elsewhere. Until the first one it does what
/// another device says, if there is one, or stands; what that one says later does not count.
class HeldDevice : public Device {
 public:
  struct Settings {
    HandMotion::Bounds bounds;
    double lease = 0.1;  ///< [s]
  };

  HeldDevice(const Settings& settings, double haptic_hz, const ToolDofs& start);
  HeldDevice(const Settings& settings, double haptic_hz, std::unique_ptr<Device> until_taken);

  DeviceSample read(double seconds) override;
  void render(const Wrench& wrench, double grip) override;
  bool finished(double) const override { return false; }
  bool on_bus() const override { return true; }
  void put(const DeviceSample& sample) override { newest_.put(sample); }

 private:
  HandMotion motion_;
  Lease lease_;
  Latest<DeviceSample> newest_;
  std::unique_ptr<Device> until_taken_;  ///< null: it stands
  std::uint64_t seq_ = 0;                ///< of the sample that leads it; 0: not taken yet
};

}  // namespace palpate
