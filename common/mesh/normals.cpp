#include "common/mesh/normals.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>

namespace palpate {

void vertex_normals(std::span<const Eigen::Vector3f> positions, std::span<const std::array<int, 3>> triangles,
                    std::span<Eigen::Vector3f> normals) {
  assert(positions.size() == normals.size());
  std::fill(normals.begin(), normals.end(), Eigen::Vector3f::Zero());
  for (const auto& [a, b, c] : triangles) {
    const Eigen::Vector3f area = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
    normals[a] += area;
    normals[b] += area;
    normals[c] += area;
  }
  for (Eigen::Vector3f& normal : normals) {
    const float length = normal.norm();
    normal = length > 0 ? Eigen::Vector3f(normal / length) : Eigen::Vector3f::Zero();
  }
}

}  // namespace palpate
