#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace palpate {

/// The last thing before the hand: finite check, limits of force and torque, slew limits. A force that rises, or turns
/// elsewhere, is what a hand is startled by; one that falls is let go faster, since a force that is held on to pushes
/// a hand that has turned round. After a fault the force ramps to zero within ramp_seconds and stays there.
class SafetyChain {
 public:
  static constexpr double kFall = 20;  ///< times the slew limit of a force that rises
  static constexpr double kRampSeconds = 0.005;
  /// [m] at which the largest force makes the largest torque: a long instrument's shaft. Contacts that pull against
  /// one another make torque without force.
  static constexpr double kMaxLever = 0.3;

  /// Limits: force [N], rate at which the force rises [N/s]; dt [s] is the step.
  SafetyChain(double max_force, double max_force_rate, double dt);

  /// The limits of force and torque alone, for what must know them before the slew limits: both shrink together.
  /// Returns force_limited or 0; what is not finite is left.
  std::uint32_t limit(Eigen::Vector3d& force, Eigen::Vector3d& torque) const;

  /// Turns what the tissue asks for into what the hand gets; force and torque are scaled alike.
  /// `healthy` false reports a fault of this step. Returns ForceFlag bits.
  std::uint32_t apply(Eigen::Vector3d& force, Eigen::Vector3d& torque, bool healthy);

  double max_force() const { return max_force_; }  ///< [N]
  bool faulted() const { return state_.faulted; }
  void trip() { state_.faulted = 1; }

  /// Plain state, for replay.
  struct State {
    double force[3] = {0, 0, 0}, torque[3] = {0, 0, 0};
    double ramp_force = 0, ramp_torque = 0;  ///< size at the time of the fault
    std::uint8_t faulted = 0;
  };
  const State& state() const { return state_; }
  void set_state(const State& state) { state_ = state; }

 private:
  std::uint32_t limit_change(Eigen::Vector3d& force, Eigen::Vector3d& torque);

  double max_force_, max_rise_, dt_;
  State state_;
};

}  // namespace palpate
