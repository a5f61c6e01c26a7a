#pragma once
#include "common/describe/description.hpp"

namespace palpate {

/// An electric scalpel: removes the dynamic tissue that the tip touches while the pedal is down.
struct Cautery {
  double radius = 0;  ///< [m] of the sphere that cuts, about the tip's centre; 0: the tip's
};

inline void describe(Description& d, Cautery& c) {
  d.number(
      {"radius", "m", "of the sphere that cuts, about the tip's centre", Need::optional, Use::agreed, "the tool's"},
      c.radius, above(0));
}

}  // namespace palpate
