#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace palpate {

/// A second-order hand on a device: mass of both, and the spring and damper of the grip towards the intended path.
struct EmulatedHand {
  double mass, damping, stiffness;                                                ///< [kg], [N s/m], [N/m]
  Eigen::Vector3d at = Eigen::Vector3d::Zero(), speed = Eigen::Vector3d::Zero();  ///< [m], [m/s] of the tip, world

  /// Goes on for `dt` [s] towards `intended` [m] under the force [N] on the tool: where it rests, stiffness times the
  /// way that it lacks is the force. Semi-implicit Euler in as many parts as are stable.
  void move(const Eigen::Vector3d& intended, const Eigen::Vector3d& force, double dt) {
    const double fastest = damping / mass + std::sqrt(stiffness / mass);  // [1/s]
    const int parts = std::max(10, static_cast<int>(std::ceil(2 * dt * fastest)));
    for (int i = 0; i < parts; ++i) {
      const Eigen::Vector3d push = stiffness * (intended - at) - damping * speed + force;
      speed += push / mass * dt / parts;
      at += speed * dt / parts;
    }
  }
};

}  // namespace palpate
