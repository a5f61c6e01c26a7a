#include "common/models/vibration.hpp"

#include "common/mesh/mesh_file.hpp"
#include "common/mesh/quality.hpp"
#include "common/models/kind.hpp"

namespace palpate {

FreeVibration vibration_of(const StaticProblem& problem) {
  const TetMesh& mesh = problem.mesh;
  FreeVibration free{assemble_stiffness(mesh, problem.materials, problem.dofs),
                     Eigen::VectorXd::Zero(problem.dofs.size())};
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const double density = problem.materials.at(static_cast<int>(t)).density;
    const double quarter = density * tet_volume(mesh, mesh.tetrahedra[t]) / 4;
    for (const int node : mesh.tetrahedra[t])
      for (int axis = 0; axis < 3; ++axis)
        if (problem.dofs.is_free(node, axis)) free.mass[problem.dofs.index(node, axis)] += quarter;
  }
  return free;
}

}  // namespace palpate
