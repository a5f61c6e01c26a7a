#pragma once
#include <span>
#include <vector>

#include "common/contact/touch_body.hpp"
#include "common/models/catheter/catheter_body.hpp"
#include "common/tool/grip.hpp"

namespace palpate {

/// What a forceps may take hold of. Null entries are bodies of another kind.
struct Graspable {
  std::span<const std::unique_ptr<TouchBody>> bodies;
  std::span<const std::unique_ptr<CatheterBody>> catheters;
};

/// One forceps at work: finds what lies between its jaws, closes them until they touch it, takes hold, and lets go when
/// the handle opens or the load slips out of the jaws. What slips while the handle is being opened is let go, not
/// dropped. What has been dropped is not taken again before the handle has opened.
class ForcepsHand {
 public:
  ForcepsHand(int tool, const Tool& settings, double dt);

  /// The jaws stand as the handle wants them.
  void start(double commanded) { state_ = {.grip = grip_at(law_, commanded)}; }
  /// One step. `pose`: tip frame at the step's begin, as `within` stands.
  GripEvent work(double commanded, const Eigen::Isometry3d& pose, const Graspable& within);

  double opening() const { return state_.grip.opening; }            ///< [rad] between the jaws
  double torque() const { return grip_torque(state_.grip, law_); }  ///< [N m] on the handle, opens the jaws
  const ForcepsShape& shape() const { return shape_; }

  /// Plain memory, for replay.
  struct State {
    Grip grip;
    double tightest = 0;  ///< [rad] least that the handle has asked for in this hold
    bool slipped = false;
  };
  const State& state() const { return state_; }
  void set_state(const State& state) { state_ = state; }

 private:
  struct Found {
    double opening = 0, distance = 0;
  };
  Found between_jaws_of(const Eigen::Isometry3d& pose, const Graspable& within);
  Found find_catheter(const CatheterBody& catheter, const Eigen::Isometry3d& pose) const;
  Found find_tissue(const TouchBody& body, const Eigen::Isometry3d& pose);
  double load(const Graspable& within) const;
  void take(const Eigen::Isometry3d& pose, const Graspable& within);
  void let_go(const Graspable& within) const;

  static constexpr std::size_t most_obstacles = 512;

  int tool_;
  ForcepsShape shape_;
  GripLaw law_;
  double dt_, compliance_;
  State state_;
  std::vector<GripObstacle> obstacles_;
};

}  // namespace palpate
