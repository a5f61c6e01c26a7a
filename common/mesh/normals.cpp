#include "common/mesh/normals.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>

namespace palpate {
namespace {

template <class Vector>
void find_normals(std::span<const Vector> positions, std::span<const std::array<int, 3>> triangles,
                  std::span<Vector> normals) {
  assert(positions.size() == normals.size());
  std::fill(normals.begin(), normals.end(), Vector::Zero());
  for (const auto& [a, b, c] : triangles) {
    const Vector area = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
    normals[a] += area;
    normals[b] += area;
    normals[c] += area;
  }
  for (Vector& normal : normals) {
    const auto length = normal.norm();
    if (length > 0) normal /= length;
  }
}

}  // namespace

void vertex_normals(std::span<const Eigen::Vector3f> positions, std::span<const std::array<int, 3>> triangles,
                    std::span<Eigen::Vector3f> normals) {
  find_normals(positions, triangles, normals);
}
void vertex_normals(std::span<const Eigen::Vector3d> positions, std::span<const std::array<int, 3>> triangles,
                    std::span<Eigen::Vector3d> normals) {
  find_normals(positions, triangles, normals);
}

}  // namespace palpate
