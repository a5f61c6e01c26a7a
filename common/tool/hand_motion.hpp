#pragma once
#include "common/tool/pose_values.hpp"

namespace palpate {

/// Smooth motion at the haptic rate from poses that come some sixty times a second. Each new pose is led up to over
/// `delay`, or longer where that would be faster than the bounds, and a critically damped filter rounds the corners:
/// position and velocity have no jumps, and no speed exceeds the bounds.
class HandMotion {
 public:
  static constexpr double kSmoothing = 0.004;  ///< [s] time constant of the filter; it lags by twice that

  struct Bounds {
    double delay = 0.02;  ///< [s] over which a new pose is led up to: longer than poses are apart
    double speed = 0.25;  ///< [m/s] of the tip
    double turn = 6;      ///< [rad/s] of roll and grip
  };

  HandMotion(const Bounds& bounds, double dt) : bounds_(bounds), dt_(dt) {}

  /// The tool stands here.
  void stand(const ToolDofs& at);
  /// Something else leads it, a step on from the last one to here. From there on it comes to rest by itself, and where
  /// somebody wants it then it is led up to slowly at first: that place is where it was a moment ago.
  void follow(const ToolDofs& at);
  /// Somebody wants it there.
  void aim(const ToolDofs& target);
  /// It goes no further than where it is led up to now.
  void hold() { left_ = 0; }
  /// The next step's pose.
  ToolDofs step();

 private:
  double steps_for(const PoseValues& from, const PoseValues& to) const;

  Bounds bounds_;
  double dt_;
  PoseValues led_{}, pace_{};      ///< where it is led up to, and how far in a step
  PoseValues first_{}, smooth_{};  ///< the filter's two stages
  PoseValues carried_{};           ///< in a step, by what led it before
  int left_ = 0, meeting_ = 0;     ///< steps until it is led to the target, and for which it is led slowly
  double pedal_ = 0;
};

}  // namespace palpate
