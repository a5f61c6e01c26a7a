#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/bus/log_reader.hpp"
#include "common/devices/device.hpp"
#include "common/tool/dofs_of.hpp"
#include "idl/topics.hpp"

namespace palpate {
namespace {

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
      const ToolDofs dofs = dofs_of(state);
      if (state.step - first > samples_.size() + kMaxGap)
        throw std::runtime_error(fmt::format("{}: the motion of tool '{}' (number {}) lacks {} steps in a row",
                                             file.string(), place.tool.name, place.index,
                                             state.step - first - samples_.size()));
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
  static constexpr std::size_t kMaxGap = 600'000;  // ten minutes at 1 kHz
  static constexpr std::size_t kMaxSamples = 50'000'000;
  std::size_t at(double seconds) const { return static_cast<std::size_t>(std::llround(seconds * rate_hz_)); }
  double rate_hz_;
  std::vector<DeviceSample> samples_;
};

}  // namespace

std::unique_ptr<Device> make_device(const LogDeviceSpec& spec, const DevicePlace& place) {
  return std::make_unique<LogDevice>(spec.trajectory, place);
}

}  // namespace palpate
