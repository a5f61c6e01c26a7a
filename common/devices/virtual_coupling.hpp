#pragma once
#include <Eigen/Core>
#include <algorithm>

#include "common/devices/emulated_hand.hpp"

namespace palpate {

/// Between the tip and where a hand that feels nothing leads it: a spring, critically damped, that the force at the tip
/// stretches, and that pulls no harder than `kStrength`. A tool that meets nothing is where it is led.
class VirtualCoupling {
 public:
  static constexpr double kMass = 0.02, kDamping = 5, kStiffness = 300;  ///< [kg], [N s/m], [N/m]
  static constexpr double kStrength = 2;                                 ///< [N]
  /// [N/m] of the tissue against which it rests in ticks of 1 ms: a force that comes a tick late and stays for one
  /// takes 1.5 ticks times the stiffness from the damping.
  static constexpr double kStiffestTissue = kDamping / 1.5e-3;

  /// Goes on for `dt` [s] under the force [N] on the tool. How far the tip is from where it is led [m], world.
  const Eigen::Vector3d& step(const Eigen::Vector3d& force, double dt) {
    const double way = tip_.at.norm(), reach = kStrength / kStiffness;
    const Eigen::Vector3d pulled_to = (1 - reach / std::max(way, reach)) * tip_.at;
    tip_.move(pulled_to, force, dt);
    if (force.isZero(0) && tip_.at.norm() < kNothing && tip_.speed.norm() < kNothing) tip_.at = tip_.speed = {0, 0, 0};
    return tip_.at;
  }

 private:
  static constexpr double kNothing = 1e-9;  ///< [m], [m/s]

  EmulatedHand tip_{kMass, kDamping, kStiffness};  ///< as seen from where it is led
};

}  // namespace palpate
