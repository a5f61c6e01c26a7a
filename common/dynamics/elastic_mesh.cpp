#include "common/dynamics/elastic_mesh.hpp"

#include <stdexcept>

#include "common/archive/archive.hpp"

namespace palpate {

std::vector<Eigen::Vector3d> ElasticMesh::dead_loads() const {
  std::vector<Eigen::Vector3d> loads = load;
  loads.resize(rest.size(), Eigen::Vector3d::Zero());
  return loads;
}

ElasticMesh elastic_mesh(const Archive& archive, TetElement element) {
  if (archive.tetrahedra.empty())
    throw std::runtime_error("body '" + archive.body + "': no part of it moves with inertia");
  ElasticMesh mesh{archive.surface.position,
                   archive.tetrahedra,
                   archive.surface.fixed,
                   {},
                   archive.material_of_element,
                   element,
                   archive.load};
  for (std::size_t m = 0; m < archive.young.size(); ++m)
    mesh.materials.push_back({archive.young[m], archive.poisson[m], archive.density[m]});
  return mesh;
}

}  // namespace palpate
