#include "common/models/static_state.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common/mesh/mesh_file.hpp"
#include "common/models/kind.hpp"

namespace palpate {

DirectProblem direct_problem(const NamedSpec& body) {
  throw std::runtime_error(fmt::format("body '{}' is not of tetrahedra, which the direct method is for", body.name));
}

DirectProblem direct_problem(const SolidSpec& body) {
  return direct_problem_of(make_static_problem(body, load_tet_mesh(body.mesh, body.scale)));
}

DirectProblem direct_problem_of(StaticProblem problem) {
  TetMesh mesh = problem.mesh;
  return {std::move(mesh), [problem = std::move(problem)](const auto& constraints, const auto& loads) {
            return solve_direct(problem, constraints, loads);
          }};
}

}  // namespace palpate
