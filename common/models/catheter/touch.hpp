#pragma once
#include <Eigen/Core>

#include "common/geometry/anchor.hpp"

namespace palpate {

/// A material point of the catheter's centre line: `along` of the way from particle `segment` to the next
/// one.
struct ChainPoint {
  int segment = 0;
  double along = 0;  ///< in [0, 1]
};

/// A place where the catheter touches, or may touch within the tick: a spring on one side along a normal,
/// with friction across it. It pushes the catheter along the normal and what it touches the other way.
struct CatheterTouch {
  ChainPoint point;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double overlap =
      0;  ///< [m] how far they overlap if nothing but a tool moves in the rest of the tick; negative: a gap
  double compliance = 0;  ///< [m/N]
  double friction = 0;    ///< [1]
  double grip = 0;  ///< [N] largest friction: the coefficient times the normal force, the lesser of the last tick's and
                    ///< this one's; 0: newly met
  Eigen::Vector3d carried = Eigen::Vector3d::Zero();  ///< [m] motion of the tool's surface in the whole tick
  bool on_wall = false;
  Anchor anchor;                                 ///< on the wall
  int part = 0;                                  ///< of the tools' parts in the order given
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< [m] world: the touched point

  // What the solution makes of it.
  bool active = false;
  double sticking = 0;                              ///< [N/m] stiffness of the friction within one substep
  double normal_force = 0;                          ///< [N] mean over the tick
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< [N] on the catheter, mean over the tick
};

}  // namespace palpate
