#include "common/models/vibration.hpp"

#include "common/dynamics/spring_mass.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/spring_mass/spec.hpp"

namespace palpate {

/// Springs at rest have no tension: each is stiff along itself alone.
FreeVibration vibration(const SpringMassSpec& body) {
  const StaticProblem problem = make_static_problem(body, load_tet_mesh(body.mesh, body.scale));
  const TetMesh& mesh = problem.mesh;
  const DofMap& dofs = problem.dofs;
  const SpringMass<double> springs(
      {mesh.nodes, mesh.tetrahedra, {}, problem.materials.materials, problem.materials.of_element}, Integrator::rk4, 0);
  std::vector<Eigen::Triplet<double, std::int64_t>> entries;
  for (int s = 0; s < springs.springs(); ++s) {
    const auto [a, b] = springs.ends(s);
    const Eigen::Vector3d along = (mesh.nodes[b] - mesh.nodes[a]).normalized();
    for (const auto& [row, column, sign] : {std::tuple(a, a, 1), {b, b, 1}, {a, b, -1}, {b, a, -1}})
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
          if (dofs.is_free(row, r) && dofs.is_free(column, c) && dofs.index(row, r) >= dofs.index(column, c))
            entries.emplace_back(dofs.index(row, r), dofs.index(column, c),
                                 sign * springs.stiffness(s) * along[r] * along[c]);
  }
  FreeVibration free{SparseMatrix(dofs.size(), dofs.size()), Eigen::VectorXd(dofs.size())};
  free.stiffness.setFromTriplets(entries.begin(), entries.end());
  for (int i = 0; i < dofs.size(); ++i) free.mass[i] = springs.mass(dofs.dof(i) / 3);
  return free;
}

}  // namespace palpate
