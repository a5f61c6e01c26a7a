#pragma once
#include <Eigen/Core>
#include <string>

namespace palpate {

/// One thing that a motion does.
struct MotionStep {
  enum class Kind { to, press, press_with, hold, slide, withdraw, grip, pedal };
  Kind kind;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< [m] to, slide: the surface's nearest place is meant
  double value = 0;  ///< press: depth [m]; press_with: force [N]; hold: time [s]; grip: jaws [rad]; pedal: 1 down
  std::string text;  ///< as it was told
};

/// "to X,Y,Z", "press 4mm", "press 0.5N", "hold 1s", "slide X,Y,Z", "withdraw", "grip 0.4", "pedal 1". Lengths are in
/// metres unless mm or cm follow. Throws std::runtime_error that names what is wrong.
MotionStep parse_motion_step(const std::string& text);

}  // namespace palpate
