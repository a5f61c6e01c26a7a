#pragma once
#include <Eigen/Geometry>
#include <algorithm>

namespace palpate {

/// A straight piece from start to end [m]; a point where they are equal.
struct Segment {
  Eigen::Vector3d start = Eigen::Vector3d::Zero(), end = Eigen::Vector3d::Zero();

  Eigen::Vector3d at(double share) const { return start + share * (end - start); }  ///< share 0: start, 1: end
  double length() const { return (end - start).norm(); }
};

/// Share in [0, 1] of the way from start to end at which a segment comes nearest to p; 0 for a point.
inline double nearest_share(const Segment& s, const Eigen::Vector3d& p) {
  const Eigen::Vector3d along = s.end - s.start;
  const double square = along.squaredNorm();
  return square > 0 ? std::clamp((p - s.start).dot(along) / square, 0.0, 1.0) : 0.0;
}

inline Eigen::Vector3d nearest_point(const Segment& s, const Eigen::Vector3d& p) {
  return s.at(nearest_share(s, p));
}

/// A part of a tool for collision: all points within `radius` of a segment; a sphere where its length is 0.
struct ToolPart {
  Eigen::Isometry3d pose =
      Eigen::Isometry3d::Identity();  ///< in the tip frame: origin at the segment's start, z along it
  double length = 0;                  ///< [m]
  double radius = 0;                  ///< [m]

  /// The segment in the world for a pose of the tip frame.
  Segment axis(const Eigen::Isometry3d& tip) const {
    const Eigen::Vector3d start = tip * pose.translation();
    if (length == 0) return {start, start};
    return {start, start + length * (tip.linear() * pose.linear().col(2))};
  }
};

}  // namespace palpate
