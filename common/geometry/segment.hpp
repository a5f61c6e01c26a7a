#pragma once
#include <Eigen/Core>
#include <algorithm>

#include "common/geometry/triangle.hpp"

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

/// Where two segments come nearest to each other; of parallel ones, the middle of where they run beside each other.
struct ClosestOfSegments {
  double share_a = 0, share_b = 0;  ///< of the way from start to end, in [0, 1]
  double squared_distance = 0;      ///< [m^2]
};
ClosestOfSegments closest_points(const Segment& a, const Segment& b);

/// Where a segment and a triangle come nearest to each other; if they meet, a point of both. Of a segment along the
/// triangle's plane one of the nearest points; see also level_share().
struct ClosestOfTriangle {
  double share = 0;                                    ///< of the segment
  Eigen::Vector3d weights = Eigen::Vector3d::UnitX();  ///< barycentric, of the triangle
  double squared_distance = 0;                         ///< [m^2]
};
ClosestOfTriangle closest_points(const Segment& segment, const Triangle& triangle);

/// The middle of the part of a segment around `nearest` whose distance from the triangle exceeds that at `nearest`, the
/// least one, by at most `tie` [m]: where a segment that lies along a triangle touches it. To a thousandth of the
/// segment.
double level_share(const Segment& segment, const Triangle& triangle, double nearest, double tie);

/// How a part of a tool touches a surface point: a sphere about `centre` on its axis that meets the point, or would
/// push it, along the unit vector `normal`, from the tool into the tissue.
struct Touching {
  Eigen::Vector3d centre, normal;
};

/// `side`: unit, into the tissue. A point outside the part and ahead of its axis is met on the shortest way. One within
/// it or behind it is led out along `side`: so contact keeps to the side where it began, however deep the tool has
/// come, and the normal does not turn about where a point lies near the axis. On the way out it goes at most `thrust`
/// [m] along the axis; where `side` leads farther, it is led out across the axis.
Touching touching(const Segment& axis, double radius, const Eigen::Vector3d& point, const Eigen::Vector3d& side,
                  double thrust);

}  // namespace palpate
