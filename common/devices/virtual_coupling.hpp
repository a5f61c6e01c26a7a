#pragma once
#include <Eigen/Core>
#include <algorithm>

namespace palpate {

/// Between the tip and where a hand that feels nothing leads it: a spring, critically damped, that the force at the tip
/// stretches, and that pulls no harder than `kStrength`. A tool that meets nothing is where it is led.
///
/// The mass is what a hand and its device have. A light one follows each change of the force, and tissue that answers
/// some ticks late, as from a node of its own, feeds its swing: 20 g buzz by newtons at a grasp that is told 5 ms late,
/// these swing by millinewtons at 20 ms. A mass that is led into stiff tissue would press it by its momentum; what goes
/// against the force is braked for that.
class VirtualCoupling {
 public:
  static constexpr double kMass = 0.33, kDamping = 20, kStiffness = 300;  ///< [kg], [N s/m], [N/m]
  static constexpr double kStrength = 2;                                  ///< [N]
  /// [m/s] Into what resists, beyond which the damper does not pull: a mouse that goes fast presses 1 N more at most.
  static constexpr double kPulledIn = 0.05;
  /// [N/m] of the tissue against which it rests in ticks of 1 ms: a force that comes a tick late and stays for one
  /// takes 1.5 ticks times the stiffness from the damping.
  static constexpr double kStiffestTissue = kDamping / 1.5e-3;
  /// [s^2/m^2] The brake's force over the force at the tip, by the square of the speed against that: slow presses are
  /// free of it.
  static constexpr double kBrake = 1000;

  /// Goes on for `dt` [s], in which the tool is led on by `led` [m], under the force [N] on the tool. How far the tip
  /// is from where it is led [m], world.
  const Eigen::Vector3d& step(const Eigen::Vector3d& force, const Eigen::Vector3d& led, double dt) {
    const double size = force.norm(), part = dt / kParts;
    const Eigen::Vector3d out = size > 0 ? Eigen::Vector3d(force / size) : Eigen::Vector3d::Zero();
    const double led_in = -out.dot(led) / dt;
    const Eigen::Vector3d push = force + kDamping * std::max(led_in - kPulledIn, 0.0) * out;
    for (int i = 0; i < kParts; ++i) {
      speed_ += (push + pull()) / kMass * part;
      const double in = std::max(led_in - out.dot(speed_), 0.0);
      speed_ += in * (1 - 1 / (1 + kBrake * size * in * part / kMass)) * out;
      at_ += speed_ * part;
    }
    if (size == 0 && at_.norm() < kNothing && speed_.norm() < kNothing) at_ = speed_ = {0, 0, 0};
    return at_;
  }

 private:
  static constexpr double kNothing = 1e-9;  ///< [m], [m/s]
  static constexpr int kParts = 10;         ///< of a step, semi-implicit

  /// [N] Of spring and damper.
  Eigen::Vector3d pull() const {
    const double share = kStrength / std::max(kStiffness * at_.norm(), kStrength);
    return -share * kStiffness * at_ - kDamping * speed_;
  }

  Eigen::Vector3d at_ = Eigen::Vector3d::Zero(), speed_ = Eigen::Vector3d::Zero();  ///< from where it is led
};

}  // namespace palpate
