#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "tools/organ/solid.hpp"

namespace palpate {

struct SurfacePoint {
  Eigen::Vector3d place;   ///< [m]
  Eigen::Vector3d inward;  ///< of length 1
};

/// So many points tell how thick a body is.
inline constexpr std::size_t kWallPoints = 2000;

/// [m] Depth of a place below the surface, or `most`, whichever is less; it may be negative outside. Of the middle of a
/// ball all of the surface is at one distance: none of it is looked at where less is enough.
using DepthUpTo = std::function<double(const Eigen::Vector3d& x, double most)>;

/// How thick the thinnest twentieth of a surface's points find the body, going inward until they are less than `near`
/// [m] below the surface. Infinite where few points face a surface nearly
/// parallel to theirs: edges and tips are no walls. `exact`: asked too where `depth` may be too little; may be absent.
/// Needs a point.
ThinWall thin_wall(const std::vector<SurfacePoint>& points, const DepthUpTo& depth, double near,
                   const DepthUpTo& exact = {});

}  // namespace palpate
