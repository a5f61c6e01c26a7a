#include "tools/study/one_mesh.hpp"

#include <fmt/format.h>

#include <numeric>

#include "common/models/hybrid/join_meshes.hpp"
#include "common/models/hybrid/precompute.hpp"

namespace palpate::study {

std::optional<OneMesh> on_one_mesh(const HybridSpec& body) {
  TetMesh mesh = load_tet_mesh(body.mesh, body.scale);
  if (body.hybrid.mesh.empty()) return OneMesh{body, body, std::move(mesh)};
  const TetMesh moving = load_tet_mesh(body.hybrid.mesh, body.hybrid.scale);
  if (!precompute(body, mesh, &moving).condensed->gap.empty()) return {};
  std::vector<int> part(moving.tetrahedra.size());
  std::iota(part.begin(), part.end(), static_cast<int>(mesh.tetrahedra.size()));
  HybridSpec whole = body;
  whole.hybrid = {.regions = {{{.indices = part, .box = {}, .group = {}}}}, .mesh = {}};
  return OneMesh{whole, whole, join_meshes(mesh, moving, fmt::format("body '{}'", body.name)), true};
}

std::optional<OneMesh> on_one_mesh(const Body& body) {
  return std::visit([](const auto& spec) { return on_one_mesh(spec); }, body);
}

}  // namespace palpate::study
