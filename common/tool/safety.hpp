#pragma once
#include <cstdint>

#include "common/tool/port.hpp"

namespace palpate {

/// The last thing before the hand: finite check, limits of force and torque at the tip and, apart from them, of the
/// torque on the handle, and slew limits of both. No tick changes the force by more than the slew limit lets it,
/// whether it rises, falls or turns. What is held on to so pushes a hand that moves away: where it were to put more
/// than kMaxHeldOn into the hand until it is gone if what is asked for stays as it is, it is let go faster, and at once
/// where the watch over the energy has nothing to spare. After a fault all of it ramps to zero within kRampSeconds and
/// stays there.
class SafetyChain {
 public:
  static constexpr double kMaxHeldOn = 1e-3;  ///< [J], and half as much again where the last tick of it is felt
  static constexpr double kRampSeconds = 0.005;
  /// [m] at which the largest force makes the largest torque: a long instrument's shaft. Contacts that pull against
  /// one another make torque without force.
  static constexpr double kMaxLever = 0.3;
  /// [m] the same of the torque on the handle: a finger's ring is that far from the handle's joint.
  static constexpr double kHandleLever = 0.1;

  struct Tick {
    PortMotion motion;          ///< of the tool since the last one
    double spare = kMaxHeldOn;  ///< [J] that what is held on to may put into the hand, as the watch over it says
    bool healthy = true;        ///< false: a fault of this step
  };

  /// Limits: force [N], rate at which the force changes [N/s]; dt [s] is the step.
  SafetyChain(double max_force, double max_force_rate, double dt);

  /// The limits of size alone, for what must know them before the slew limits: force and torque shrink together.
  /// Returns force_limited or 0; what is not finite is left.
  std::uint32_t limit(PortForce& wanted) const;

  /// Turns what the tissue asks for into what the hand gets; force and torque are scaled alike. Returns ForceFlag bits.
  std::uint32_t apply(PortForce& wanted, const Tick& tick);

  double max_force() const { return max_force_; }  ///< [N]
  bool faulted() const { return state_.faulted; }
  void trip() { state_.faulted = 1; }

  /// Plain state, for replay.
  struct State {
    double force[3] = {0, 0, 0}, torque[3] = {0, 0, 0}, grip = 0;
    double ramp_force = 0, ramp_torque = 0, ramp_grip = 0;  ///< size at the time of the fault
    std::uint8_t faulted = 0;
  };
  const State& state() const { return state_; }
  void set_state(const State& state) { state_ = state; }

 private:
  void ramp_down();
  std::uint32_t limit_change(Eigen::Vector3d& force, Eigen::Vector3d& torque, const Tick& tick) const;
  std::uint32_t limit_change(double& grip, const Tick& tick) const;

  double max_force_, max_change_, dt_;  ///< max_change_ [N] in a step
  State state_;
};

}  // namespace palpate
