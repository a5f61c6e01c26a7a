#pragma once
#include <Eigen/Geometry>

#include "common/geometry/triangle.hpp"

namespace palpate {

/// Barycentric coordinates of a point in the triangle's plane, inside of it or not; of a point off the plane, those of
/// its foot. The triangle has an area.
inline Eigen::Vector3d plane_coordinates(const Triangle& t, const Eigen::Vector3d& p) {
  const Eigen::Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double w1 = (p - t[0]).cross(t[2] - t[0]).dot(n) / n.squaredNorm();
  const double w2 = (t[1] - t[0]).cross(p - t[0]).dot(n) / n.squaredNorm();
  return {1 - w1 - w2, w1, w2};
}

}  // namespace palpate
