#include "common/models/vibration.hpp"

#include "common/fem/consistent_mass.hpp"
#include "common/fem/fine_problem.hpp"
#include "common/fem/lumped_mass.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/quasi_static/precompute.hpp"

namespace palpate {
namespace {

FreeVibration vibration_of(FineProblem problem) {
  const Pressures* pressures = problem.pressures ? &*problem.pressures : nullptr;
  FreeVibration free{assemble_stiffness(problem.space, problem.materials, pressures, problem.dofs,
                                        fine_graph(problem.space, pressures)),
                     Eigen::VectorXd(problem.dofs.size())};
  const std::vector<double> mass = lumped_mass(problem.space, problem.materials);
  for (int i = 0; i < problem.dofs.size(); ++i) free.mass[i] = mass[problem.dofs.dof(i) / 3];
  if (problem.space.per_element == 10)
    free.consistent_mass = [problem = std::move(problem)](const Eigen::MatrixXd& x) {
      return times_consistent_mass(problem.space, problem.materials, problem.dofs, x);
    };
  return free;
}

}  // namespace

FreeVibration vibration(const QuasiStaticSpec& body) {
  const TetMesh mesh = load_tet_mesh(body.mesh, body.scale);
  const Offline offline = *with_offline(body, mesh).offline;
  if (!is_finer(offline)) return vibration_of(make_static_problem(body, mesh));
  return vibration_of(make_fine_problem(body, mesh, offline));
}

}  // namespace palpate
