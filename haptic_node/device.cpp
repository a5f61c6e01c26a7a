#include "haptic_node/device.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <stdexcept>

#include "common/bus/log_reader.hpp"
#include "common/realtime/latest.hpp"
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

/// Plays the tool states of a log, one per step as they were consumed.
class LogDevice : public Device {
 public:
  LogDevice(const std::filesystem::path& file, const DevicePlace& place) : rate_hz_(place.haptic_hz) {
    LogReader log(file);
    std::uint64_t first = 0;
    LogEvent event;
    ToolState state;
    while (log.next(event)) {
      if (!event.read(topics::tool_state, state) || state.tool != place.index) continue;
      if (samples_.empty()) first = state.step;
      if (state.step < first) continue;
      const ToolDofs dofs{state.yaw, state.pitch, state.depth, state.roll, state.grip, state.pedal};
      // A step whose sample was lost repeats the one before it.
      while (!samples_.empty() && samples_.size() < state.step - first && samples_.size() < kMaxSamples)
        samples_.push_back(samples_.back());
      if (samples_.size() < kMaxSamples) samples_.push_back({dofs, state.seq});
    }
    if (samples_.empty())
      throw std::runtime_error(fmt::format("{}: the log holds no motion of tool '{}' (number {})", file.string(),
                                           place.tool.name, place.index));
  }
  DeviceSample read(double seconds) override { return samples_[std::min(at(seconds), samples_.size() - 1)]; }
  bool finished(double seconds) const override { return at(seconds) >= samples_.size(); }

 private:
  static constexpr std::size_t kMaxSamples = 50'000'000;
  std::size_t at(double seconds) const { return static_cast<std::size_t>(std::llround(seconds * rate_hz_)); }
  double rate_hz_;
  std::vector<DeviceSample> samples_;
};

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

std::unique_ptr<Device> make_device(const ScriptedDeviceSpec& spec, const DevicePlace& place) {
  return std::make_unique<ScriptedDevice>(spec.trajectory, place.tool);
}

std::unique_ptr<Device> make_device(const LogDeviceSpec& spec, const DevicePlace& place) {
  return std::make_unique<LogDevice>(spec.trajectory, place);
}

std::unique_ptr<Device> make_device(const BusDeviceSpec&, const DevicePlace&) {
  return std::make_unique<BusDevice>();
}

std::unique_ptr<Device> make_device(const Scene& scene, int tool) {
  const DevicePlace place{scene.tools[tool], static_cast<std::uint32_t>(tool), scene.rates.haptic_hz};
  return std::visit([&](const auto& spec) { return make_device(spec, place); }, place.tool.device);
}

BusDevices::BusDevices(Bus& bus, std::vector<std::unique_ptr<Device>>& devices) {
  for (std::size_t t = 0; t < devices.size(); ++t)
    if (devices[t]->on_bus()) targets_.push_back({static_cast<std::uint32_t>(t), devices[t].get()});
  if (needed()) reader_ = bus.reader(topics::device_state);
}

bool BusDevices::needed() const {
  return !targets_.empty();
}

void BusDevices::take() {
  while (const auto sample = reader_->take())
    for (const Target& target : targets_)
      if (target.tool == sample->tool)
        target.device->put(
            {{sample->yaw, sample->pitch, sample->depth, sample->roll, sample->grip, sample->pedal}, sample->seq});
}

}  // namespace palpate
