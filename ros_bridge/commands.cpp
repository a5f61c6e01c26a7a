#include "ros_bridge/commands.hpp"

#include <fmt/format.h>

#include <utility>

#include "common/devices/device.hpp"
#include "common/log/log.hpp"
#include "common/realtime/clock.hpp"
#include "ros_bridge/joints.hpp"

namespace palpate::ros {

Commands::Commands(Node& node, Bus& bus, const Scene& scene) : node_(node), writer_(bus.writer(topics::device_state)) {
  // Above every number of a bridge that ran before on this machine.
  const auto first = static_cast<std::uint64_t>(now_ns() / 1'000'000);
  const auto devices = make_devices(scene.tools, scene.rates.haptic_hz);
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (!devices[i]->on_bus()) continue;
    const std::string topic = "/palpate/" + allowed_name(scene.tools[i].name) + "/command";
    tools_.push_back({topic,
                      node.subscription(topic, sensor_msgs_msg_dds__JointState__desc),
                      {.tool = static_cast<std::uint32_t>(i), .seq = first}});
  }
}

void Commands::begin() {
  if (tools_.empty()) return;
  thread_ = std::jthread([this](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      node_.wait(std::chrono::milliseconds(50));
      for (Commanded& tool : tools_) take(tool);
    }
  });
}

void Commands::end() {
  thread_ = {};
}

void Commands::take(Commanded& tool) {
  const auto receive = [&](const void* sample) {
    const std::string wrong = follow(*static_cast<const sensor_msgs_msg_dds__JointState_*>(sample), tool.state);
    if (!wrong.empty()) {
      ++refused_;
      if (!std::exchange(tool.said, true)) log_warning(fmt::format("{}: command refused: {}", tool.name, wrong));
      return;
    }
    ++tool.state.seq;
    tool.state.sense_ns = now_ns();
    ++(writer_->write(tool.state) ? taken_ : refused_);
  };
  while (tool.reader.take(receive)) continue;
}

}  // namespace palpate::ros
