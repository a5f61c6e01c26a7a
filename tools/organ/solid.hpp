#pragma once
#include <Eigen/Core>
#include <functional>
#include <limits>

namespace palpate {

/// Where a solid is thin.
struct ThinWall {
  double thickness = std::numeric_limits<double>::infinity();  ///< [m]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();             ///< [m] on its surface
};

/// Parts of space, in a frame of their own, as a mesher asks for them. `part` and `depth` are called some million
/// times.
struct Solid {
  std::function<int(const Eigen::Vector3d&)> part;                 ///< 0 outside; else which of the parts, from 1
  std::function<double(const Eigen::Vector3d&)> depth;             ///< [m] about how far the nearest surface is; >= 0
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> nearest;  ///< of the surface, exact; may be absent
  /// [m] How far the surface may be moved outward at a place of it: 0 where another body faces it across a gap, and it
  /// stays. Absent: as far as is wanted.
  std::function<double(const Eigen::Vector3d&)> room;
  Eigen::Vector3d low, high;  ///< [m] a box around all parts, not touching them
  int parts = 1;
  ThinWall wall;
  /// From that frame to the one in which places are told.
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> in_world = [](const Eigen::Vector3d& x) { return x; };
};

}  // namespace palpate
