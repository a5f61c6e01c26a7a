#include "common/models/moving/static_problem.hpp"

#include <numeric>

#include "common/mesh/mesh_file.hpp"
#include "common/models/kind.hpp"
#include "common/models/moving/precompute.hpp"
#include "common/models/static_state.hpp"
#include "common/models/vibration.hpp"

namespace palpate {

StaticProblem moving_problem(const MovingSpec& body, TetMesh mesh, const std::vector<int>& moving) {
  StaticProblem problem = make_static_problem(body, std::move(mesh));
  problem.materials = with_elements(body, moving, problem.mesh, std::move(problem.materials));
  return problem;
}

StaticProblem moving_problem(const MovingSpec& body, TetMesh mesh) {
  std::vector<int> all(mesh.tetrahedra.size());
  std::iota(all.begin(), all.end(), 0);
  return moving_problem(body, std::move(mesh), all);
}

FreeVibration vibration(const MovingSpec& body) {
  return vibration_of(moving_problem(body, load_tet_mesh(body.mesh, body.scale)));
}

DirectProblem direct_problem(const MovingSpec& body) {
  return direct_problem_of(moving_problem(body, load_tet_mesh(body.mesh, body.scale)));
}

}  // namespace palpate
