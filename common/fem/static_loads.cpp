#include "common/fem/static_loads.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "common/fem/hat_tractions.hpp"
#include "common/fem/lumped_mass.hpp"
#include "common/mesh/quality.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// Outward, as long as the triangle is large [m^2].
Vector3d area_of(const std::vector<Vector3d>& position, int a, int b, int c) {
  return 0.5 * (position[b] - position[a]).cross(position[c] - position[a]);
}

std::array<int, 3> sorted(std::array<int, 3> corners) {
  std::ranges::sort(corners);
  return corners;
}

/// int N over a face with straight edges, as a share of its area: of quadratic displacements the midpoints' alone.
void add_to_face(const FineFace& face, const Vector3d& force, std::vector<Vector3d>& load) {
  for (int i = 0; i < 3; ++i) load[face.node[face.count - 3 + i]] += force / 3;
}

void add_pressures(const std::vector<SurfacePressure>& pressures, const FineSpace& space, std::vector<Vector3d>& load) {
  std::map<std::array<int, 3>, double> on;
  for (const SurfacePressure& p : pressures) on[sorted(p.triangle)] += p.pressure;
  for (const FineFace& face : fine_surface(space)) {
    const auto found = on.find(sorted(run_time_corners(space, face)));
    if (found == on.end()) continue;
    add_to_face(face, -found->second * area_of(space.nodes, face.node[0], face.node[1], face.node[2]), load);
  }
}

/// int N over a tetrahedron with straight edges, as a share of its volume: 1/4, or -1/20 at corners and 1/5 at
/// midpoints.
double share_of_volume(const FineSpace& space, int local) {
  if (space.per_element == 4) return 0.25;
  return local < 4 ? -0.05 : 0.2;
}

void add_weight(const Vector3d& gravity, const FineSpace& space, const MaterialField& materials,
                std::vector<Vector3d>& load) {
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const double density = materials.at(static_cast<int>(e) / space.children).density;
    const Vector3d weight = density * tet_volume(space.mesh, space.mesh.tetrahedra[e]) * gravity;
    for (int i = 0; i < space.per_element; ++i) load[space.elements[e][i]] += share_of_volume(space, i) * weight;
  }
}

}  // namespace

std::vector<SurfacePressure> pressures_on(const std::vector<std::array<int, 3>>& triangles,
                                          const std::vector<int>& nodes, double pressure) {
  std::vector<SurfacePressure> pressures;
  for (const auto& t : triangles)
    if (std::ranges::all_of(t, [&](int n) { return std::ranges::binary_search(nodes, n); }))
      pressures.push_back({t, pressure});
  return pressures;
}

std::array<NodalLoad, 3> corner_loads(const SurfacePressure& p, const std::vector<Vector3d>& position) {
  const auto& [a, b, c] = p.triangle;
  const Vector3d third = -p.pressure / 3 * area_of(position, a, b, c);
  return {NodalLoad{a, third}, NodalLoad{b, third}, NodalLoad{c, third}};
}

std::vector<Vector3d> force_vector(const StaticLoads& loads, const std::vector<Vector3d>& position) {
  std::vector<Vector3d> load(position.size(), Vector3d::Zero());
  for (const NodalLoad& one : loads.nodes) load.at(one.node) += one.force;
  for (const SurfacePressure& p : loads.pressures)
    for (const NodalLoad& one : corner_loads(p, position)) load.at(one.node) += one.force;
  return load;
}

std::vector<Vector3d> load_vector(const StaticLoads& loads, const TetMesh& mesh, const MaterialField& materials) {
  const std::vector<double> mass = lumped_mass(mesh, materials);
  std::vector<Vector3d> load = force_vector(loads, mesh.nodes);
  for (std::size_t n = 0; n < load.size(); ++n) load[n] += mass[n] * loads.gravity;
  return load;
}

std::vector<Vector3d> fine_load_vector(const StaticLoads& loads, const FineSpace& space,
                                       const MaterialField& materials) {
  std::vector<Vector3d> load(space.nodes.size(), Vector3d::Zero());
  if (!loads.pressures.empty()) add_pressures(loads.pressures, space, load);
  if (!loads.gravity.isZero(0)) add_weight(loads.gravity, space, materials, load);
  return load;
}

}  // namespace palpate
