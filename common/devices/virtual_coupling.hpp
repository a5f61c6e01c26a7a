#pragma once
#include <Eigen/Core>
#include <algorithm>

#include "common/devices/emulated_hand.hpp"

namespace palpate {

/// Between the tip and where a hand that feels nothing leads it: a spring, critically damped, that the force at the tip
/// stretches, and that pulls no harder than `kStrength`. A tool that meets nothing is where it is led.
///
/// The mass is what a hand and its device have. A light one follows each change of the force, and tissue that answers
/// some ticks late, as a node of its own does, feeds its swing: 20 g buzz at a grasp that is told 5 ms late, where
/// these rest at 20 ms. A mass that is led into stiff tissue would press it by its momentum; what goes against the
/// force is braked for that.
class VirtualCoupling {
 public:
  static constexpr double kMass = 0.33, kDamping = 20, kStiffness = 300;  ///< [kg], [N s/m], [N/m]
  static constexpr double kStrength = 2;                                  ///< [N]
  /// [N/m] of the tissue against which it rests in ticks of 1 ms: a force that comes a tick late and stays for one
  /// takes 1.5 ticks times the stiffness from the damping.
  static constexpr double kStiffestTissue = kDamping / 1.5e-3;
  /// [s^2/m^2] The brake's force over the force at the tip, by the square of the speed against that: slow presses are
  /// free of it.
  static constexpr double kBrake = 1000;

  /// Goes on for `dt` [s], in which the tool is led on by `led` [m], under the force [N] on the tool. How far the tip
  /// is from where it is led [m], world.
  const Eigen::Vector3d& step(const Eigen::Vector3d& force, const Eigen::Vector3d& led, double dt) {
    const double way = tip_.at.norm(), reach = kStrength / kStiffness;
    const Eigen::Vector3d pulled_to = (1 - reach / std::max(way, reach)) * tip_.at;
    tip_.move(pulled_to, force, dt);
    brake(force, led / dt, dt);
    if (force.isZero(0) && tip_.at.norm() < kNothing && tip_.speed.norm() < kNothing) tip_.at = tip_.speed = {0, 0, 0};
    return tip_.at;
  }

 private:
  static constexpr double kNothing = 1e-9;  ///< [m], [m/s]

  void brake(const Eigen::Vector3d& force, const Eigen::Vector3d& led_speed, double dt) {
    const double size = force.norm();
    if (size == 0) return;
    const Eigen::Vector3d out = force / size;
    const double against = -out.dot(tip_.speed + led_speed);
    if (against > 0) tip_.speed += against * (1 - 1 / (1 + kBrake * size * against * dt / kMass)) * out;
  }

  EmulatedHand tip_{kMass, kDamping, kStiffness};  ///< as seen from where it is led
};

}  // namespace palpate
