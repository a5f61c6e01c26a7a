#include "common/devices/device.hpp"
#include "common/devices/emulated_hand.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {
namespace {

/// The tip is a mass on a spring and damper towards the intended path; roll, jaws and pedal are the path's own.
class HandDevice : public Device {
 public:
  HandDevice(const HandDeviceSpec& spec, const Tool& tool)
      : trocar_(make_trocar(tool.pivot, tool.axis, tool.up)),
        intended_(load_trajectory(spec.trajectory)),
        hand_{spec.mass, spec.damping, spec.stiffness} {
    check_grip(intended_, spec.trajectory, tool);
    hand_.at = tip_at(intended_.at(0));
  }

  DeviceSample read(double seconds) override {
    ToolDofs dofs = intended_.at(seconds);
    if (seconds > seconds_) hand_.move(tip_at(dofs), force_, seconds - seconds_);
    seconds_ = seconds;
    const ToolDofs at = dofs_for_tip(trocar_, hand_.at, dofs.roll);
    dofs.yaw = at.yaw, dofs.pitch = at.pitch, dofs.depth = at.depth;
    return {dofs, 0};
  }
  void render(const Wrench& wrench, double) override { force_ = wrench.force; }
  bool finished(double seconds) const override { return seconds > intended_.duration(); }

 private:
  Eigen::Vector3d tip_at(const ToolDofs& dofs) const { return tip_pose(trocar_, dofs).translation(); }

  Trocar trocar_;
  Trajectory intended_;
  EmulatedHand hand_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();  ///< [N] on the tool, of the last step
  double seconds_ = 0;
};

}  // namespace

std::unique_ptr<Device> make_device(const HandDeviceSpec& spec, const DevicePlace& place) {
  return std::make_unique<HandDevice>(spec, place.tool);
}

}  // namespace palpate
