#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/contact/contact_law.hpp"
#include "common/sim/local_stiffness.hpp"

namespace palpate {

/// [N/m] How the force of each contact grows as its tool moves:
///   K_i = sum over the same tool's contacts j of (A^-1)_ij, A = P C P^T
/// over everything that all tools hold, C being the tissue's static compliance; three rows for what sticks, the normal
/// alone for what slides. Zero for a contact that is open, or on a node whose compliance `known` does not hold (yet):
/// the share of the others alone would be taken for a stiff place.
std::vector<Eigen::Matrix3d> contact_stiffness(const LocalStiffness::Answer& known,
                                               std::span<const TouchContact> contacts);

}  // namespace palpate
