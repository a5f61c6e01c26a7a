#include "common/models/vibration.hpp"

#include <fmt/format.h>

#include "common/mesh/mesh_file.hpp"
#include "common/models/hybrid/join_meshes.hpp"
#include "common/models/hybrid/spec.hpp"

namespace palpate {

// Both parts as one elastic body.
FreeVibration vibration(const HybridSpec& body) {
  TetMesh mesh = load_tet_mesh(body.mesh, body.scale);
  if (has_own_mesh(body))
    mesh = join_meshes(mesh, load_tet_mesh(body.hybrid.mesh, body.hybrid.scale),
                       fmt::format("body '{}': [body.hybrid]", body.name));
  return vibration_of(make_static_problem(body, std::move(mesh)));
}

}  // namespace palpate
