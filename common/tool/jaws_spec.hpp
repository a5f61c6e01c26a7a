#pragma once
#include "common/describe/description.hpp"

namespace palpate {

/// Two jaws of a probe that hold the tissue between them once closed.
struct ClosingJaws {
  double length = 0.012;      ///< [m] along the shaft
  double width = 0.006;       ///< [m] across the plane they open in
  double closed_below = 0.1;  ///< [rad] of grip
};

inline void describe(Description& d, ClosingJaws& j) {
  d.number(
      {"length", "m", "of what they hold, from the tip's centre onwards along the shaft; of a forceps of each jaw"},
      j.length, above(0));
  d.number({"width", "m", "of the same, across the shaft; of a probe alone"}, j.width, above(0));
  d.number({"closed_below", "rad", "of grip; of a probe alone"}, j.closed_below, above(0));
}

/// The jaws of a forceps, hinged at the tip's centre, each turned by half the opening.
struct TurningJaws {
  double length = 0.012;        ///< [m] of each
  double radius = 0.001;        ///< [m] of each about its segment
  double max_open = 1.0;        ///< [rad] between the jaws
  double grip_stiffness = 0.5;  ///< [N m/rad] of the handle's linkage: closing torque per angle beyond the touch
  double friction = 0.8;        ///< [1] between jaws and what they hold; beyond it the hold slips
};

inline void describe(Description& d, TurningJaws& j) {
  d.number(
      {"length", "m", "of what they hold, from the tip's centre onwards along the shaft; of a forceps of each jaw"},
      j.length, above(0));
  d.number({"radius", "m", "of each jaw about its segment; of a forceps alone, like the rest"}, j.radius, above(0));
  d.number({"max_open", "rad", "between the jaws; a trajectory whose grip is larger or negative is refused"},
           j.max_open, above_up_to(0, 2.5));
  d.number({"grip_stiffness", "N m/rad",
            "of the linkage: torque that closes the jaws per angle that the handle goes beyond the touch"},
           j.grip_stiffness, above(0));
  d.number({"friction", "1", "Coulomb's coefficient between the jaws and what they hold; beyond it the hold slips"},
           j.friction, at_least(0));
}

}  // namespace palpate
