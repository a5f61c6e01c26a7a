#include "common/mesh/measures.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/mesh/quality.hpp"

namespace palpate {
namespace {

double degrees(double angle) {
  return angle * 180 / std::numbers::pi;
}

/// [rad] Least and greatest angle between two faces.
std::pair<double, double> angles_of(const TetMesh& mesh, const std::array<int, 4>& t) {
  std::array<Eigen::Vector3d, 4> normal;
  for (int f = 0; f < 4; ++f) {
    const auto& [a, b, c] = kTetFaces[f];
    const Eigen::Vector3d& corner = mesh.nodes[t[a]];
    normal[f] = (mesh.nodes[t[b]] - corner).cross(mesh.nodes[t[c]] - corner).normalized();
  }
  double least = std::numbers::pi, greatest = 0;
  for (int f = 0; f < 4; ++f)
    for (int g = f + 1; g < 4; ++g) {
      const double angle = std::numbers::pi - std::acos(std::clamp(normal[f].dot(normal[g]), -1.0, 1.0));
      least = std::min(least, angle), greatest = std::max(greatest, angle);
    }
  return {least, greatest};
}

}  // namespace

MeshMeasures measures_of(const TetMesh& mesh) {
  MeshMeasures m{{}, 0, 180, 0, 0};
  Eigen::Vector3d low = mesh.nodes[mesh.tetrahedra[0][0]], high = low;
  std::vector<double> smallest;
  for (const auto& t : mesh.tetrahedra) {
    for (const int n : t) low = low.cwiseMin(mesh.nodes[n]), high = high.cwiseMax(mesh.nodes[n]);
    m.volume += tet_volume(mesh, t);
    const auto [least, greatest] = angles_of(mesh, t);
    smallest.push_back(degrees(least));
    m.max_angle = std::max(m.max_angle, degrees(greatest));
  }
  m.extent = high - low;
  m.min_angle = *std::ranges::min_element(smallest);
  const auto middle = smallest.begin() + static_cast<std::ptrdiff_t>(smallest.size() / 2);
  std::ranges::nth_element(smallest, middle);
  m.median_angle = *middle;
  return m;
}

std::string say_size(const MeshMeasures& m, double mass) {
  return fmt::format("{:.4g} x {:.4g} x {:.4g} mm, {:.4g} ml, {:.4g} kg", 1e3 * m.extent.x(), 1e3 * m.extent.y(),
                     1e3 * m.extent.z(), 1e6 * m.volume, mass);
}

std::string say_angles(const MeshMeasures& m) {
  return fmt::format("dihedral angles: smallest {:.1f}, median {:.1f}, largest {:.1f} degrees", m.min_angle,
                     m.median_angle, m.max_angle);
}

}  // namespace palpate
