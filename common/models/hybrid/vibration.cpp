#include "common/models/vibration.hpp"

#include <optional>

#include "common/mesh/mesh_file.hpp"
#include "common/models/hybrid/hybrid_split.hpp"
#include "common/models/hybrid/precompute.hpp"
#include "common/models/moving/static_problem.hpp"
#include "common/models/static_state.hpp"

namespace palpate {

// Both parts as one elastic body.
FreeVibration vibration(const HybridSpec& body) {
  const TetMesh mesh = load_tet_mesh(body.mesh, body.scale);
  std::optional<TetMesh> coarse;
  if (has_own_mesh(body)) coarse = load_tet_mesh(body.hybrid.mesh, body.hybrid.scale);
  HybridParts parts = find_parts(body, mesh, coarse ? &*coarse : nullptr);
  return vibration_of(moving_problem(body, std::move(parts.mesh), parts.dynamic));
}

// Where the part that moves has a mesh of its own, the body's mesh alone.
DirectProblem direct_problem(const HybridSpec& body) {
  TetMesh mesh = load_tet_mesh(body.mesh, body.scale);
  const std::vector<int> moving = has_own_mesh(body) ? std::vector<int>() : dynamic_elements(body, mesh);
  return direct_problem_of(moving_problem(body, std::move(mesh), moving));
}

}  // namespace palpate
