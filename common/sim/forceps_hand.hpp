#pragma once
#include <span>
#include <vector>

#include "common/contact/body_part.hpp"
#include "common/tool/grip.hpp"

namespace palpate {

/// One forceps at work: finds what lies between its jaws, closes them until they touch it, takes hold, and lets go when
/// the handle opens or the load slips out of the jaws. What slips while the handle is being opened is let go, not
/// dropped. What has been dropped is not taken again before the handle has opened.
class ForcepsHand {
 public:
  ForcepsHand(int tool, const Tool& settings, double dt);

  /// The jaws stand as the handle wants them.
  void start(double commanded) { state_ = {.grip = grip_at(law_, commanded)}; }
  /// One step. `pose`: tip frame at the step's begin, as the bodies stand.
  GripEvent work(double commanded, const Eigen::Isometry3d& pose, BodyParts bodies);

  double opening() const { return state_.grip.opening; }            ///< [rad] between the jaws
  double torque() const { return grip_torque(state_.grip, law_); }  ///< [N m] on the handle, opens the jaws
  const ForcepsShape& shape() const { return shape_; }

  /// Plain memory, for replay.
  struct Memory {
    Grip grip;
    double tightest = 0;  ///< [rad] least that the handle has asked for in this hold
    bool slipped = false;
  };
  const Memory& state() const { return state_; }
  void set_state(const Memory& state) { state_ = state; }

 private:
  OpenJaws jaws(const Eigen::Isometry3d& pose) const { return {tool_, shape_, pose, state_.grip.opening, compliance_}; }
  BetweenJaws between(const Eigen::Isometry3d& pose, BodyParts bodies) const;
  GripEvent grip(double commanded, const Eigen::Isometry3d& pose, BodyParts bodies);

  int tool_;
  ForcepsShape shape_;
  GripLaw law_;
  double dt_, compliance_;
  Memory state_;
};

}  // namespace palpate
