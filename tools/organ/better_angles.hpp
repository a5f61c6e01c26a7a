#pragma once
#include "tools/organ/fill_solid.hpp"

namespace palpate {

/// Moves nodes of tetrahedra with a dihedral angle of less than `wanted` [degrees] to where the least angle around them
/// is larger: inner ones anywhere, those of the outer surface along it where it is smooth, those between parts not.
/// No node leaves its place by more than a quarter of the shortest edge at it.
void better_angles(double wanted, FilledSolid& filled);

}  // namespace palpate
