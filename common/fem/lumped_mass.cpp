#include "common/fem/lumped_mass.hpp"

#include "common/mesh/quality.hpp"

namespace palpate {

std::vector<double> lumped_mass(const TetMesh& mesh, const MaterialField& materials) {
  std::vector<double> mass(mesh.nodes.size(), 0.0);
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    const auto& tet = mesh.tetrahedra[e];
    for (int node : tet) mass[node] += materials.at(static_cast<int>(e)).density * tet_volume(mesh, tet) / 4;
  }
  return mass;
}

std::vector<double> lumped_mass(const FineSpace& space, const MaterialField& materials) {
  const bool quadratic = space.per_element == 10;
  std::vector<double> mass(space.nodes.size(), 0.0);
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const double density = materials.at(static_cast<int>(e) / space.children).density;
    const double own = density * tet_volume(space.mesh, space.mesh.tetrahedra[e]);
    for (int i = 0; i < space.per_element; ++i)
      mass[space.elements[e][i]] += own * (quadratic ? (i < 4 ? 1. / 36 : 4. / 27) : 1. / 4);
  }
  return mass;
}

}  // namespace palpate
