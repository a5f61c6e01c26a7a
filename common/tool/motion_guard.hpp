#pragma once
#include <cstdint>
#include <optional>

#include "common/tool/kinematics.hpp"

namespace palpate {

/// Between a device and its tool: what the tool does is a motion that a hand can make, whatever the device says, so
/// that no sample asks for a sweep that a step cannot compute. A sample out of range, or far from where the tool is and
/// not confirmed by the next one, is refused and the tool stands still; what is confirmed is followed at a bounded
/// speed. A motion within the bounds passes in all its bits.
class MotionGuard {
 public:
  static constexpr double kMaxAngle = 10;     ///< [rad] either way, of all angles
  static constexpr double kMaxDepth = 2;      ///< [m] either way
  static constexpr double kMaxSpeed = 2;      ///< [m/s] of the tip
  static constexpr double kMaxTurn = 30;      ///< [rad/s] of roll and grip
  static constexpr double kJump = 0.05;       ///< [m] of the tip, beyond which a sample must be confirmed
  static constexpr double kJumpAngle = 0.75;  ///< [rad] of roll and grip, likewise

  explicit MotionGuard(double dt) : dt_(dt) {}

  /// Whether a tool can be there at all; false for what is not a number.
  static bool in_range(const ToolDofs& sample);

  /// Where the tool goes in this step, for the device's newest sample. `seq`: of the sample; one that is seen again
  /// confirms nothing. A scripted motion has 0, and each step's pose is a sample.
  ToolDofs follow(const ToolDofs& sample, std::uint64_t seq);

  std::uint64_t refused() const { return refused_; }    ///< samples that were out of range or not confirmed
  std::uint64_t followed() const { return followed_; }  ///< steps in which the tool was slower than its device

 private:
  bool plausible(const ToolDofs& sample) const;

  double dt_;
  std::optional<ToolDofs> at_;    ///< where the tool is; none before the first sample, which is taken as it is
  std::optional<ToolDofs> seen_;  ///< the last sample that was new and within range
  std::uint64_t seq_ = 0;
  bool accepted_ = true;  ///< the sample seen last
  std::uint64_t refused_ = 0, followed_ = 0;
};

}  // namespace palpate
