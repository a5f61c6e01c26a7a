#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "common/contact/patch/patch.hpp"

namespace palpate {

/// Leaves forces on the `most` nodes that carry the most; each other one goes to the nearest of those, so that the sum
/// stays. `position` [m] of all nodes, at rest.
void hand_to_fewer(std::size_t most, std::span<const Eigen::Vector3d> position, std::vector<PatchForce>& forces);

}  // namespace palpate
