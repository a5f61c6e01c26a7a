#pragma once
#include "common/archive/archive.hpp"

namespace palpate {

/// Makes an archive one of the same body with another Young's modulus [Pa], those of its material regions scaled alike:
/// of linear elasticity, and of neo-Hookean presses to given depths, all stored numbers are proportional to a power of
/// it. Stiffness, forces at given displacements and `condensed->bound` are to E, displacements under given forces to
/// 1/E, frequencies of modes to its square root; mode shapes, `follow` and `reaction` to neither. No rounding at
/// factor 1.
void scale_young(Archive& archive, double young);

}  // namespace palpate
