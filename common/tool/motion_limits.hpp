#pragma once
#include "common/describe/description.hpp"
#include "common/tool/kinematics.hpp"

namespace palpate {

/// Where a tool can be, and how it can move: what its device says beyond is refused or followed slowly (MotionGuard).
struct MotionLimits {
  static constexpr double kMaxAngle = 10;  ///< [rad] either way, of all angles
  static constexpr double kMaxDepth = 2;   ///< [m] either way

  double max_angle = kMaxAngle;                          ///< [rad] either way, of yaw and pitch
  double min_depth = -kMaxDepth, max_depth = kMaxDepth;  ///< [m]
  double max_speed = 2;                                  ///< [m/s] of the tip
  double max_turn = 30;                                  ///< [rad/s] of roll and grip
  double jump = 0.05;                                    ///< [m] of the tip, beyond which a sample must be confirmed
  double jump_angle = 0.75;                              ///< [rad] of roll and grip, likewise

  /// Whether the tool can be there; false for what is not a number.
  bool allow(const ToolDofs& dofs) const;
};

inline void describe(Description& d, MotionLimits& m) {
  d.number({"max_angle", "rad", "of yaw and pitch, either way; a sample beyond is refused"}, m.max_angle,
           within(1e-3, MotionLimits::kMaxAngle));
  d.number({"min_depth", "m", "likewise"}, m.min_depth, within(-MotionLimits::kMaxDepth, MotionLimits::kMaxDepth));
  d.number({"max_depth", "m", "likewise"}, m.max_depth, within(-MotionLimits::kMaxDepth, MotionLimits::kMaxDepth));
  d.require(m.min_depth < m.max_depth, "min_depth", "min_depth must be less than max_depth");
  d.number({"max_speed", "m/s", "of the tip; a faster motion is followed at it"}, m.max_speed, within(1e-3, 2));
  d.number({"max_turn", "rad/s", "of roll and grip, likewise"}, m.max_turn, within(1e-3, 30));
  d.number({"jump", "m", "of the tip from one sample to the next, beyond which the one after must confirm it"}, m.jump,
           within(1e-4, 0.05));
  d.number({"jump_angle", "rad", "of roll and grip, likewise"}, m.jump_angle, within(1e-3, 0.75));
}

}  // namespace palpate
