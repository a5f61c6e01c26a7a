#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/bus/messages.hpp"
#include "common/scene/scene.hpp"
#include "common/tensors/archive.hpp"
#include "common/tool/kinematics.hpp"
#include "haptic_node/safety.hpp"
#include "haptic_node/touch_body.hpp"

namespace palpate {

/// One tick of the haptic loop as a function of the tools' degrees of freedom and of its own state:
/// sense, collide, hold, force. It allocates nothing, takes no lock and does no I/O after construction, and gives
/// the same bits for the same inputs on the same code path.
class HapticStep {
 public:
  /// One archive per body, read with ArchivePart::touchable.
  HapticStep(const Scene& scene, const std::vector<Archive>& archives);
  ~HapticStep();

  int tools() const { return static_cast<int>(moving_.size()); }
  int bodies() const { return static_cast<int>(bodies_.size()); }
  double dt() const { return dt_; }  ///< [s] nominal period

  /// Sets the tools' poses before the first step. Throws std::runtime_error naming tool and body if one starts in
  /// contact, unless `resuming` (a peer keeps this run's contacts).
  void start(std::span<const ToolDofs> dofs, bool resuming = false);
  /// Takes up a contact that a peer kept. Throws std::runtime_error if it does not fit this scene.
  void adopt(std::uint32_t tool, const HeldContact& contact);

  void step(std::span<const ToolDofs> dofs);

  /// What the hand gets [N, N m], on the tool at its tip, world frame.
  const Eigen::Vector3d& force(int tool) const { return output_[tool].force; }
  const Eigen::Vector3d& torque(int tool) const { return output_[tool].torque; }
  std::uint32_t flags(int tool) const { return output_[tool].flags; }
  const Eigen::Vector3d& press(int tool) const { return output_[tool].press; }
  const Eigen::Isometry3d& pose(int tool) const { return moving_[tool].now; }
  const TouchBody& body(int b) const { return *bodies_[b]; }
  void trip();  ///< fault from outside: the force ramps to zero

  /// Changing state as bytes, to start a replay from. save() leaves the factor forgotten, so that the run goes on
  /// bit for bit as one that begins with restore().
  std::size_t state_size() const;
  void save(std::span<std::uint8_t> to);
  void forget_factors();
  void restore(std::span<const std::uint8_t> from);  ///< throws std::runtime_error on a state of another scene

 private:
  struct Output {
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero(), press = Eigen::Vector3d::Zero();
    std::uint32_t flags = 0;
  };
  bool sense(std::span<const ToolDofs> dofs);

  double dt_;
  std::vector<Trocar> trocars_;
  std::vector<std::string> tool_names_, body_names_;
  std::vector<std::vector<SampleSphere>> samples_;
  std::vector<MovingTool> moving_;
  std::vector<std::unique_ptr<TouchBody>> bodies_;
  std::vector<SafetyChain> safety_;
  std::vector<ToolLoad> loads_;
  std::vector<Output> output_;
};

}  // namespace palpate
