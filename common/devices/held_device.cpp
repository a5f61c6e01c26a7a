#include "common/devices/held_device.hpp"

#include <algorithm>

#include "common/tool/fade.hpp"

namespace palpate {

HeldDevice::HeldDevice(const Settings& settings, const DevicePlace& place, const ToolDofs& start)
    : dt_(1 / place.haptic_hz),
      trocar_(make_trocar(place.tool.pivot, place.tool.axis, place.tool.up)),
      motion_(settings.bounds, dt_),
      lease_(settings.lease) {
  motion_.stand(start);
}

HeldDevice::HeldDevice(const Settings& settings, const DevicePlace& place, std::unique_ptr<Device> until_taken)
    : HeldDevice(settings, place, until_taken->read(0).dofs) {
  until_taken_ = std::move(until_taken);
}

DeviceSample HeldDevice::read(double seconds) {
  const DeviceSample sample = newest_.get();
  const bool news = sample.seq != 0 && sample.seq != seq_;
  if (seq_ == 0 && !news) {
    if (!until_taken_) return {motion_.step(), 0};
    const DeviceSample own = until_taken_->read(seconds);
    motion_.follow(own.dofs);
    return {own.dofs, 0};
  }
  if (news) {
    seq_ = sample.seq;
    motion_.aim(sample.dofs);
    lease_.heard(seconds);
  }
  silent_ = lease_.over(seconds);
  if (silent_) motion_.hold();
  faded_ = silent_ ? 1 : std::max(faded_ - dt_ / kReturnSeconds, 0.0);
  DeviceSample now{giving_way(motion_.step()), seq_};
  now.dofs.silent = silent_;
  if (silent_) now.dofs.pedal = 0;
  return now;
}

ToolDofs HeldDevice::giving_way(ToolDofs led) {
  const Eigen::Vector3d tip = tip_pose(trocar_, led).translation();
  const Eigen::Vector3d& off = coupling_.step(felt_, tip - led_to_.value_or(tip), dt_);
  led_to_ = tip;
  if (off.isZero(0)) return led;
  const ToolDofs at = dofs_for_tip(trocar_, tip + off, led.roll);
  led.yaw = at.yaw, led.pitch = at.pitch, led.depth = at.depth;
  return led;
}

// Who leads it has no motors; the device that leads it until then may have them.
void HeldDevice::render(const Wrench& wrench, double grip) {
  if (seq_ == 0) {
    if (until_taken_) until_taken_->render(wrench, grip);
  } else if (!silent_) {
    felt_ = wrench.force + faded_ * whole_;
    if (faded_ == 0) whole_ = felt_;
  }
}

}  // namespace palpate
