#pragma once
#include <array>

#include "common/tool/kinematics.hpp"

namespace palpate {

/// How fast a tool goes while the cap is pushed all the way.
struct CapSpeeds {
  double tip = 0.05;  ///< [m/s]
  double turn = 1.5;  ///< [rad/s] of the roll
  double jaws = 1;    ///< [rad/s] of the grip
};

/// A tool that goes as the cap of a 6-axis mouse is pushed: the farther, the faster; it stays where the cap rests.
class CapMotion {
 public:
  static constexpr int kFull = 350;  ///< what an axis says when the cap is pushed all the way

  CapMotion(const ToolDofs& start, const CapSpeeds& speeds) : dofs_(start), speeds_(speeds) {}

  /// The cap's newest state: pushed to the right, up and away from the person, turned about the same axes; as
  /// spacenavd tells it.
  void push(const std::array<int, 6>& cap);
  /// The first button is the pedal; the second shuts the jaws while it is held, and they open when it is not.
  void press(int button, bool down);

  /// Goes on for `dt` [s]. Pushed down, the tip goes in along the shaft; to the right and away, along the trocar's x
  /// and y; turned about the vertical, it rolls.
  const ToolDofs& step(double dt);

 private:
  ToolDofs dofs_;
  CapSpeeds speeds_;
  std::array<double, 6> rate_{};  ///< -1 to 1
  bool shut_ = false;
};

}  // namespace palpate
