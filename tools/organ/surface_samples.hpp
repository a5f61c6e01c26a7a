#pragma once
#include <array>
#include <vector>

#include "tools/organ/solid.hpp"

namespace palpate {

/// A point on the surface between two parts, or between a part and the outside.
struct SurfaceSample {
  Eigen::Vector3d place;     ///< [m]
  std::array<int, 2> parts;  ///< ascending; 0: outside
};

/// Points on every surface that lines `step` [m] apart cross, or closer where the solid is thin: a few dozen of each
/// surface, spread over it, and on thin walls so many that none is farther than `apart` times their thickness away.
std::vector<SurfaceSample> surface_samples(const Solid& solid, double step, double apart);

}  // namespace palpate
