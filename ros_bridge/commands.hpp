#pragma once
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/scene/scene.hpp"
#include "ros_bridge/ros_node.hpp"

namespace palpate::ros {

/// Hands what comes on /palpate/NAME/command (sensor_msgs/JointState) to the tools whose driver is elsewhere, as that
/// driver, at once and on a thread of its own. The device's lease counts from sample to sample, so that a commander
/// that falls silent lets its tool go.
class Commands {
 public:
  /// Opens topics; begin() starts the thread.
  Commands(Node& node, Bus& bus, const Scene& scene);
  void begin();
  void end();

  std::uint64_t taken() const { return taken_; }
  std::uint64_t refused() const { return refused_; }  ///< with a wrong joint, or values out of range

 private:
  struct Commanded {
    std::string name;
    PlainReader reader;
    DeviceState state;
    bool said = false;  ///< what is wrong with a command
  };
  void take(Commanded& tool);

  Node& node_;
  std::unique_ptr<Writer<DeviceState>> writer_;
  std::vector<Commanded> tools_;
  std::atomic<std::uint64_t> taken_ = 0, refused_ = 0;
  std::jthread thread_;
};

}  // namespace palpate::ros
