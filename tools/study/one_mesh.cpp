#include "tools/study/one_mesh.hpp"

#include <fmt/format.h>

#include <numeric>

#include "common/mesh/mesh_file.hpp"
#include "common/models/hybrid/join_meshes.hpp"
#include "common/models/moving/precompute.hpp"

namespace palpate::study {

std::optional<OneMesh> on_one_mesh(const Body& body) {
  OneMesh one{body, load_tet_mesh(body.mesh, body.scale)};
  if (!body.hybrid || body.hybrid->mesh.empty()) return one;
  const TetMesh moving = load_tet_mesh(body.hybrid->mesh, body.hybrid->scale);
  if (!precompute_dynamic(body, one.mesh, &moving).hybrid->gap.empty()) return {};
  std::vector<int> part(moving.tetrahedra.size());
  std::iota(part.begin(), part.end(), static_cast<int>(one.mesh.tetrahedra.size()));
  one.mesh = join_meshes(one.mesh, moving, fmt::format("body '{}'", body.name));
  one.body.hybrid = Hybrid{.regions = {Selector{.indices = part, .box = {}, .group = {}}}, .mesh = {}};
  return one;
}

}  // namespace palpate::study
