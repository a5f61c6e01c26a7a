#include "common/models/static_state.hpp"

#include <algorithm>

#include "common/fem/fine_problem.hpp"
#include "common/fem/fine_space.hpp"
#include "common/models/quasi_static/nonlinear.hpp"
#include "common/models/quasi_static/precompute.hpp"

namespace palpate {
namespace {

/// The quasi non-linear correction of a linear static state, as the nodes apply it to one tool's press (TVCG99 sec.
/// 4-3): all that is held presses along the direction of its resultant force F; every force is scaled by Q(F)/F, the
/// part of every displacement across the press by P, and what is held stays where it is held. Returns Q(F)/F; 1, and
/// nothing has changed, where the resultant is zero.
double correct(const BodyNonlinear& of_body, const StaticField& state) {
  Eigen::Vector3d resultant = Eigen::Vector3d::Zero();
  PressPlace at;
  for (const int place : state.held) {
    resultant += state.force[place];
    at.add(state.position[place], state.force[place].norm());
  }
  const double size = resultant.norm();
  if (!(size > 0)) return 1;
  const QuasiNonlinear law = of_body.at(at.mean());
  const std::span<double> field(state.displacement.data()->data(), 3 * state.displacement.size());
  const std::vector<double> linear(field.begin(), field.end());
  std::ranges::fill(field, 0.0);
  add_corrected<double>(law, linear, resultant / size, field);
  keep_held<double>(state.held, linear, field);
  const double scale = law.force_scale(size);
  for (Eigen::Vector3d& force : state.force) force *= scale;
  return scale;
}

}  // namespace

DirectProblem direct_problem(const QuasiStaticSpec& body) {
  DirectProblem problem = direct_problem(static_cast<const SolidSpec&>(body));
  problem.rest = resting_loads(body, problem.mesh);
  const Offline offline = *with_offline(body, problem.mesh).offline;
  if (is_finer(offline))
    problem.solve = [&body, offline, mesh = problem.mesh](const auto& constraints, const auto& loads) {
      return solve_direct(make_fine_problem(body, mesh, offline), constraints, loads);
    };
  return problem;
}

StaticCorrection static_correction(const QuasiStaticSpec& body) {
  if (!body.nonlinear) return {};
  return [&body](const Archive& archive, const StaticField& state) {
    return correct(make_nonlinear(body, archive), state);
  };
}

}  // namespace palpate
