#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

namespace palpate {

/// A mesh to be drawn: unit normals, outward triangles.
struct PathShape {
  std::vector<Eigen::Vector3f> position, normal;
  std::vector<std::array<int, 3>> triangles;
};

/// A tube about points [m].
PathShape tube_along(const std::vector<Eigen::Vector3f>& points, float radius);
/// A ball about each of them.
PathShape balls_at(const std::vector<Eigen::Vector3f>& points, float radius);

}  // namespace palpate
