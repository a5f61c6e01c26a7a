#include "common/devices/held_device.hpp"

namespace palpate {

HeldDevice::HeldDevice(const Settings& settings, double haptic_hz, const ToolDofs& start)
    : motion_(settings.bounds, 1 / haptic_hz), lease_(settings.lease) {
  motion_.stand(start);
}

HeldDevice::HeldDevice(const Settings& settings, double haptic_hz, std::unique_ptr<Device> until_taken)
    : HeldDevice(settings, haptic_hz, until_taken->read(0).dofs) {
  until_taken_ = std::move(until_taken);
}

DeviceSample HeldDevice::read(double seconds) {
  const DeviceSample sample = newest_.get();
  const bool news = sample.seq != 0 && sample.seq != seq_;
  if (seq_ == 0 && !news && until_taken_) {
    const DeviceSample own = until_taken_->read(seconds);
    motion_.stand(own.dofs);
    return {own.dofs, 0};
  }
  if (news) {
    seq_ = sample.seq;
    motion_.aim(sample.dofs);
    lease_.heard(seconds);
  }
  const bool silent = seq_ != 0 && lease_.over(seconds);
  if (silent) motion_.hold();
  DeviceSample now{motion_.step(), seq_};
  now.dofs.silent = silent;
  if (silent) now.dofs.pedal = 0;
  return now;
}

// A pointer has no motors; the device that still leads the tool may have them.
void HeldDevice::render(const Wrench& wrench, double grip) {
  if (seq_ == 0 && until_taken_) until_taken_->render(wrench, grip);
}

}  // namespace palpate
