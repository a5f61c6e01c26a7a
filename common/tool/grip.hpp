#pragma once
#include <span>
#include <type_traits>

#include "common/tool/forceps.hpp"

namespace palpate {

/// A ball between the jaws: a catheter's particle, a point of a wall with half its thickness. Tip frame.
struct GripObstacle {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0;                                   ///< [m]
};

/// Opening [rad], from 0 to pi, at which both jaws touch a ball at p (tip frame) of this radius [m]: beyond it at most
/// one does. 0 if it is not between the jaws: beyond their length, behind J, or so far to the side that they pass it.
double opening_at_contact(const ForcepsShape& shape, const Eigen::Vector3d& p, double radius);

/// The same for a thick segment, such as a piece of a catheter (tip frame): the largest over its points.
double opening_at_contact(const ForcepsShape& shape, const Segment& segment, double radius);

/// Opening [rad] at which each jaw touches one of several balls, be they two: that of a tube lies between its walls.
/// Only balls whose centres lie between the jaws at the present `opening` [rad] count.
double opening_at_contact(const ForcepsShape& shape, std::span<const GripObstacle> obstacles, double opening);

/// What the grip of one forceps is like.
struct GripLaw {
  double max_open = 1.0;   ///< [rad]
  double stiffness = 0.5;  ///< [N m/rad] of the handle's linkage
  double friction = 0.8;   ///< [1] between jaws and what they hold
  double rate = 20;        ///< [rad/s] at most, opening and closing: a jaw of 15 mm then moves 0.15 mm in a millisecond
};

enum class GripEvent { none, taken, released, dropped };

/// The grip of one forceps: how far its jaws are open and whether they hold. Plain memory, for replay.
///
/// The jaws follow the handle until an object between them stops both. The handle, which goes on closing, then feels a
/// torque; each jaw presses the object with that torque over the object's distance from J. A hold begins once they
/// press with min_grip_force. It lasts until the handle has opened past the touch, by jaw_slack, or until the load on
/// it exceeds what friction on both jaws can bear: then the object slips, and the jaws must open before they hold it
/// again.
struct Grip {
  double opening = 0;    ///< [rad] of the jaws
  double commanded = 0;  ///< [rad] of the handle
  double touch = 0;      ///< [rad] opening at which the object stops the jaws; 0: nothing between them
  double distance = 0;   ///< [m] of what stops them from J
  bool stopped = false;  ///< by an object
  bool holding = false;
  bool slipped = false;  ///< out of the last hold, and the jaws have not opened since
};
static_assert(std::is_trivially_copyable_v<Grip>);

inline constexpr double kMinGripForce = 0.1;  ///< [N] of each jaw

/// A grip whose jaws stand where the handle wants them, at the start of a run.
Grip grip_at(const GripLaw& law, double commanded);

/// One step of dt [s]. `commanded` [rad] is taken within [0, max_open]; a value that is not a number leaves the handle
/// where it is. `touch` [rad] and `distance` [m]: opening_at_contact() of what is between the jaws, 0 for nothing, and
/// how far from J it is. `load` [N]: what pulls at the object that is held, as of the last step. Says whether a hold
/// began or ended.
GripEvent work_grip(Grip& grip, const GripLaw& law, double commanded, double touch, double distance, double load,
                    double dt);

/// [N m] on the handle, positive where it opens the jaws; 0 unless an object stops them.
double grip_torque(const Grip& grip, const GripLaw& law);
/// [N] with which each jaw presses what stops them.
double grip_force(const Grip& grip, const GripLaw& law);
/// [N] the largest load that the hold can bear: friction on both jaws.
double grip_capacity(const Grip& grip, const GripLaw& law);

}  // namespace palpate
