#pragma once
#include <Eigen/Core>
#include <vector>

namespace palpate {

/// A rigid frictionless ball.
struct Sphere {
  Eigen::Vector3d centre;  ///< [m]
  double radius;           ///< [m]
};

/// A state of a body under a ball.
struct PressState {
  std::vector<Eigen::Vector3d> displacement;        ///< [m] per node
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< [N] on the tissue
  double penetration = 0;                           ///< [m] largest depth of a node in the ball
};

}  // namespace palpate
