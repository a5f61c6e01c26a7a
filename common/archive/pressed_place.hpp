#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

namespace palpate {

/// How one place of a body answers a rigid ball that is pressed in ever deeper: by linear and by neo-Hookean
/// elasticity, on the same mesh with the same contact.
struct PressedPlace {
  using Pair = std::array<double, 2>;  ///< linear, neo-Hookean

  Eigen::Vector3d at;        ///< [m] on the rest surface
  double depth = 0;          ///< [m] of the deepest press
  std::vector<Pair> force;   ///< [N] on the tissue along the press, depth by depth; both ascend
  std::vector<Pair> radial;  ///< [m] displacement across the press, classes of nodes over all depths; the first ascends

  bool operator==(const PressedPlace&) const = default;
};

}  // namespace palpate
