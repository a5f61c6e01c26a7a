#include "tools/study/one_mesh.hpp"

#include <fmt/format.h>

#include <numeric>

#include "common/mesh/mesh_file.hpp"
#include "common/models/hybrid/join_meshes.hpp"
#include "common/models/hybrid/precompute.hpp"

namespace palpate::study {

std::optional<OneMesh> on_one_mesh(const Body& body) {
  const SolidSpec& solid = *as<SolidSpec>(body);
  OneMesh one{body, load_tet_mesh(solid.mesh, solid.scale)};
  auto* spec = as<HybridSpec>(one.body);
  if (!spec || spec->hybrid.mesh.empty()) return one;
  const TetMesh moving = load_tet_mesh(spec->hybrid.mesh, spec->hybrid.scale);
  if (!precompute(*spec, one.mesh, &moving).hybrid->gap.empty()) return {};
  std::vector<int> part(moving.tetrahedra.size());
  std::iota(part.begin(), part.end(), static_cast<int>(one.mesh.tetrahedra.size()));
  one.mesh = join_meshes(one.mesh, moving, fmt::format("body '{}'", spec->name));
  spec->hybrid = {.regions = {{{.indices = part, .box = {}, .group = {}}}}, .mesh = {}};
  return one;
}

}  // namespace palpate::study
