#pragma once
#include <memory>
#include <span>
#include <vector>

#include "common/devices/device.hpp"
#include "common/sim/simulator.hpp"
#include "common/tool/motion_guard.hpp"

namespace palpate::drive {

/// What moves the tools of a scene. Throws std::runtime_error for a missing or malformed file, or where a tool waits
/// for a driver elsewhere: who is to compute archives first asks for it before.
std::vector<std::unique_ptr<Device>> lock_step_devices(const Scene& scene);

/// A scene with what moves its tools, tick by tick, as fast as it goes: no clock, no bus, no picture. The tools'
/// motions pass the same guard as in the haptic node.
class LockStep {
 public:
  /// One archive per body, read with ArchivePart::surface. Throws std::runtime_error if the scene cannot be run or a
  /// tool starts in contact, and as lock_step_devices() does.
  LockStep(const Scene& scene, const std::vector<Archive>& archives);

  sim::Simulator& simulator() { return simulator_; }
  const sim::Simulator& simulator() const { return simulator_; }
  double time() const { return static_cast<double>(simulator_.steps()) * simulator_.dt(); }  ///< [s] of the next step
  bool motions_over() const;  ///< every tool's motion has ended before the next step; without tools never
  void step();                ///< by the devices' inputs; they get its forces
  /// A step with other inputs than the devices', one per tool, which pass the same guard; the devices get nothing.
  void step(std::span<const sim::ToolInput> inputs);
  const MotionGuard& guard(int tool) const { return guards_[tool]; }
  const std::vector<sim::ToolInput>& inputs() const { return inputs_; }  ///< of the last step, or where the tools start

 private:
  sim::Simulator simulator_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<MotionGuard> guards_;
  std::vector<sim::ToolInput> inputs_;
};

}  // namespace palpate::drive
