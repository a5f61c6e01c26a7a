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

}  // namespace palpate
