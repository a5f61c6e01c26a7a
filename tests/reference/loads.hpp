#pragma once
#include <Eigen/Geometry>
#include <functional>

#include "common/fem/direct.hpp"
#include "common/mesh/surface.hpp"

namespace palpate::testing {

/// Nodal forces of a traction [Pa] on the surface triangles that `chosen` accepts (all three corners). The
/// traction is given the triangle's outward unit normal and taken constant over each triangle.
inline std::vector<Eigen::Vector3d> traction_load(
    const TetMesh& mesh, const std::function<bool(const Eigen::Vector3d&)>& chosen,
    const std::function<Eigen::Vector3d(const Eigen::Vector3d& normal)>& traction) {
  std::vector<Eigen::Vector3d> load(mesh.nodes.size(), Eigen::Vector3d::Zero());
  for (const auto& [a, b, c] : extract_surface(mesh).triangles) {
    if (!chosen(mesh.nodes[a]) || !chosen(mesh.nodes[b]) || !chosen(mesh.nodes[c])) continue;
    const Eigen::Vector3d area = 0.5 * (mesh.nodes[b] - mesh.nodes[a]).cross(mesh.nodes[c] - mesh.nodes[a]);
    const Eigen::Vector3d share = area.norm() / 3 * traction(area.normalized());
    for (int node : {a, b, c}) load[node] += share;
  }
  return load;
}

inline double work(const std::vector<Eigen::Vector3d>& force, const std::vector<Eigen::Vector3d>& displacement) {
  double sum = 0;
  for (std::size_t i = 0; i < force.size(); ++i) sum += force[i].dot(displacement[i]);
  return sum;
}

/// Order of convergence from the errors on a mesh and on one of half its size.
inline double order(double coarse_error, double fine_error) {
  return std::log2(coarse_error / fine_error);
}

}  // namespace palpate::testing
