#include "common/models/solid/precompute.hpp"

#include <fmt/format.h>

#include "common/fem/dense.hpp"

namespace palpate {

std::vector<Dof> free_dofs(const SurfaceMap& surface, int begin, int end) {
  std::vector<Dof> dofs;
  for (int node = begin; node < end; ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (!surface.fixed[node][axis]) dofs.push_back({node, axis});
  return dofs;
}

Archive start_archive(const SolidSpec& body, std::string_view kind, const TetMesh& mesh,
                      const MaterialField& materials) {
  Archive archive;
  archive.body = body.name;
  archive.model = kind;
  archive.software = fmt::format("palpate {}, OpenBLAS for {}", PALPATE_VERSION, blas_kernels());
  archive.mesh_nodes = static_cast<int>(mesh.nodes.size());
  for (const auto& material : materials.materials) {
    archive.young.push_back(material.young);
    archive.poisson.push_back(material.poisson);
  }
  archive.material_of_element = materials.of_element;
  return archive;
}

}  // namespace palpate
