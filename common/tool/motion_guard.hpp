#pragma once
#include <cstdint>
#include <optional>

#include "common/tool/motion_limits.hpp"

namespace palpate {

/// Between a device and its tool: what the tool does is a motion that a hand can make, whatever the device says, so
/// that no sample asks for a sweep that a step cannot compute. A sample out of range, or far from where the tool is and
/// not confirmed by the next one, is refused and the tool stands still; what is confirmed is followed at a bounded
/// speed. A motion within the bounds passes in all its bits.
class MotionGuard {
 public:
  MotionGuard(const MotionLimits& limits, double dt) : limits_(limits), dt_(dt) {}

  /// Where the tool goes in this step, for the device's newest sample. `seq`: of the sample; one that is seen again
  /// confirms nothing. A scripted motion has 0, and each step's pose is a sample.
  ToolDofs follow(const ToolDofs& sample, std::uint64_t seq);

  std::uint64_t refused() const { return refused_; }    ///< samples that were out of range or not confirmed
  std::uint64_t followed() const { return followed_; }  ///< steps in which the tool was slower than its device

 private:
  bool close_by(const ToolDofs& a, const ToolDofs& b) const;
  bool plausible(const ToolDofs& sample) const;

  MotionLimits limits_;
  double dt_;
  std::optional<ToolDofs> at_;    ///< where the tool is; none before the first sample, which is taken as it is
  std::optional<ToolDofs> seen_;  ///< the last sample that was new and within range
  std::uint64_t seq_ = 0;
  bool accepted_ = true;  ///< the sample seen last
  std::uint64_t refused_ = 0, followed_ = 0;
};

}  // namespace palpate
