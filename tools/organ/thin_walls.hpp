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

/// How thick the thinnest twentieth of a surface's points find the body, going inward until `depth` below the surface
/// [m], which may be negative outside, is less than `near` [m]. Infinite where few points face a surface nearly
/// parallel to theirs: edges and tips are no walls. Needs a point.
ThinWall thin_wall(const std::vector<SurfacePoint>& points, const std::function<double(const Eigen::Vector3d&)>& depth,
                   double near);

}  // namespace palpate
