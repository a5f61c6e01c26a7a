#pragma once
#include <optional>
#include <string>

#include "tools/stability/case.hpp"

namespace palpate::stability {

/// A block of moving tissue on its bottom, and a ball, or a level shaft, that is pressed into its top beside any node
/// and stands there.
struct MovingPress {
  Eigen::Vector3i cells{6, 6, 4};
  Eigen::Vector3d cell{0.01, 0.01, 0.01};              ///< [m]
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();    ///< [m] the middle of its top
  double young = 5000, poisson = 0.3, density = 1000;  ///< [Pa], [1], [kg/m^3]
  double damping = 5;                                  ///< [1/s]
  Integrator integrator = Integrator::rk4;
  Precision precision = Precision::float32;
  bool shaft = false;                    ///< over all of the block along x, and slid across
  double radius = 0.005, depth = 0.002;  ///< [m]
  Eigen::Vector2d beside{0.12, -0.23};   ///< [1] of a cell, from the node nearest to the middle
  std::optional<double> from_rim;        ///< [1] of the radius: how far within the top's rim, along x; slid inwards
  double friction = 0;
  ContactRule rule = ContactRule::patch;
  bool corotational = false;
  TetElement element = TetElement::linear;
  std::string gesture = "held";  ///< held | tapped | slid | stabbed; then it stands
};

/// Moves it by moving tissue and, on the same path, at rest; judged by StandJudge. Throws std::runtime_error for a
/// scene that the product refuses.
Result press_moving(const MovingPress& press);

}  // namespace palpate::stability
