#pragma once
#include <optional>

#include "common/devices/device.hpp"
#include "common/devices/lease.hpp"
#include "common/devices/virtual_coupling.hpp"
#include "common/realtime/latest.hpp"
#include "common/tool/hand_motion.hpp"

namespace palpate {

/// A tool that people may take, by samples of some sixty a second from elsewhere. Until the first one it does what
/// another device says, if there is one, or stands; what that one says later does not count. Its driver feels nothing,
/// so that the tool itself gives way to the force at its tip.
class HeldDevice : public Device {
 public:
  struct Settings {
    HandMotion::Bounds bounds;
    double lease = 0.1;  ///< [s]
  };

  HeldDevice(const Settings& settings, const DevicePlace& place, const ToolDofs& start);
  HeldDevice(const Settings& settings, const DevicePlace& place, std::unique_ptr<Device> until_taken);

  DeviceSample read(double seconds) override;
  void render(const Wrench& wrench, double grip) override;
  bool finished(double) const override { return false; }
  bool on_bus() const override { return true; }
  void put(const DeviceSample& sample) override { newest_.put(sample); }

 private:
  ToolDofs giving_way(ToolDofs led);

  double dt_;
  Trocar trocar_;
  HandMotion motion_;
  VirtualCoupling coupling_;
  std::optional<Eigen::Vector3d> led_to_;  ///< [m] the tip, in the last step
  Lease lease_;
  Latest<DeviceSample> newest_;
  std::unique_ptr<Device> until_taken_;  ///< null: it stands
  std::uint64_t seq_ = 0;                ///< of the sample that leads it; 0: not taken yet
  bool silent_ = false;
  // A force that fades with a silent driver, and comes back by and by, does not move the tool.
  Eigen::Vector3d felt_ = Eigen::Vector3d::Zero(), whole_ = Eigen::Vector3d::Zero();  ///< [N] now; when it was whole
  double faded_ = 0;                                                                  ///< share of it
};

}  // namespace palpate
