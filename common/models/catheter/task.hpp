#pragma once
#include <cstdint>

namespace palpate {

/// What a trainee did with a catheter, measured in every haptic step. Plain memory: a replay may start from it.
struct Task {
  double inserted = 0;                  ///< [m] of the catheter within the duct now
  double deepest = 0;                   ///< [m]
  double first_inside_s = -1;           ///< [s] time of the run at which it first went in; -1: not yet
  double deepest_s = -1;                ///< [s] when it was deepest
  double max_force = 0;                 ///< [N] on any tool
  double held_s = 0;                    ///< [s] in which some forceps held it
  std::uint64_t wall_contacts = 0;      ///< touches begun between its particles and the duct's wall
  std::uint64_t grasps = 0, drops = 0;  ///< drops: holds that slipped out of the jaws

  /// Enters the depth [m] of a step that ended at `time` [s].
  void enter_depth(double depth, double time) {
    inserted = depth;
    if (depth > 0 && first_inside_s < 0) first_inside_s = time;
    if (depth > deepest) {
      deepest = depth;
      deepest_s = time;
    }
  }
  /// [s] from going in to the deepest point; 0 before it has gone in.
  double inserting_s() const { return first_inside_s < 0 ? 0 : deepest_s - first_inside_s; }
};

}  // namespace palpate
