#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "common/sim/tool_end.hpp"
#include "common/tool/passivity.hpp"
#include "common/tool/safety.hpp"

namespace palpate {

/// One instrument under the hand: its motion about the trocar, what is at its end, and the port through which the hand
/// gets its force.
class ToolRig {
 public:
  /// What the hand gets, and what is told of it.
  struct Output {
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();  ///< [N], [N m] on the tool, tip
    Eigen::Vector4d along = Eigen::Vector4d::Zero();   ///< the same along yaw, pitch, depth, roll [N m, N m, N, N m]
    Eigen::Vector3d press = Eigen::Vector3d::Zero();   ///< unit or zero, on the tissue
    Eigen::Vector3d trocar = Eigen::Vector3d::Zero();  ///< [N] of the trocar on the shaft
    double grip = 0;                                   ///< [N m] on the handle, opens the jaws
    std::uint32_t flags = 0;                           ///< ForceFlag bits
  };

  ToolRig(int index, const Tool& tool, double dt);

  const std::string& name() const { return name_; }
  const Trocar& trocar() const { return trocar_; }
  const ToolEnd& end() const { return *end_; }
  const MotionLimits& motion_limits() const { return motion_limits_; }
  double max_force() const { return safety_.max_force(); }  ///< [N] that the hand gets
  /// Whether tissue can be held at a place [m] in a part's own frame, or between the jaws in the tip frame.
  bool can_hold(int part, const Eigen::Vector3d& at) const;
  const Eigen::Isometry3d& pose() const { return now_; }  ///< tip frame, world
  MovingTool moving() const {
    return {.before = before_, .now = now_, .parts_before = end_->parts_before(), .parts = end_->parts()};
  }
  const Output& output() const { return output_; }

  /// The tool stands here; call once, before the first step. False for a pose that is not a number.
  bool start(const ToolDofs& dofs);
  /// The bodies have taken up the contacts that it had before it stood here.
  void set_resumed() { resumed_ = true; }
  bool resumed() const { return resumed_; }
  /// A pose that is not a number is a fault: the tool is taken to stand still, and false comes back.
  bool sense(const ToolDofs& dofs);
  /// Its jaws follow the handle.
  void work(BodyParts bodies);

  /// What the watch over the energy sees; it comes between the next two, and between the two after them.
  Port& port() { return port_; }
  /// Tells the port of the motion since the last step.
  void count_motion();
  /// The port asks for what the tissue asks for, within the limits of their size.
  void ask(const ToolLoad& load);
  /// The hand gets what the watch left of it: slew limits and a second force limit have the last word. `healthy` false
  /// reports a fault of this step.
  void give(bool healthy);
  /// What jaws let go slides out of them: its load does not leave the hand at once.
  static constexpr double kSlideOut = 0.02;  ///< [s]
  void trip() { safety_.trip(); }

  void state(State& s);

 private:
  std::string name_;
  Trocar trocar_;
  double shaft_length_;
  double jaw_length_;  ///< [m] 0 without jaws
  std::unique_ptr<ToolEnd> end_;
  SafetyChain safety_;
  double force_scale_;
  MotionLimits motion_limits_;
  ToolDofs dofs_{};
  Eigen::Isometry3d before_ = Eigen::Isometry3d::Identity(), now_ = Eigen::Isometry3d::Identity();
  double handle_ = 0;                ///< [rad] in the last step
  double fade_step_, return_step_;   ///< of held_
  double held_ = 1;                  ///< share of its force that the hand gets; below 1 once it has let go
  PortForce wanted_;                 ///< in the last step
  double sliding_ = 0, slide_step_;  ///< share of the time that what jaws let go takes to slide out, which is left
  bool lets_go_ = false;             ///< in this step
  bool resumed_ = false;
  Port port_;
  Output output_;

  void slide_out(PortForce& wanted);
  void fade(PortForce& given);
};

}  // namespace palpate
