#pragma once
#include <Eigen/Geometry>

#include "common/geometry/segment.hpp"

namespace palpate {

/// A part of a tool for collision: all points within `radius` of a segment; a sphere where its length is 0.
struct ToolPart {
  Eigen::Isometry3d pose =
      Eigen::Isometry3d::Identity();  ///< in the tip frame: origin at the segment's start, z along it
  double length = 0;                  ///< [m]
  double radius = 0;                  ///< [m]

  /// The segment in the world for a pose of the tip frame.
  Segment axis(const Eigen::Isometry3d& tip) const;
};

}  // namespace palpate
