#include "tools/study/cut_rest.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/fem/refine_graded.hpp"
#include "tools/rig/kinds.hpp"
#include "tools/study/measure.hpp"

namespace palpate::study {
namespace {

using Field = std::vector<Eigen::Vector3d>;

/// Tetrahedra of a slot beside the patch: one and a half edges wide, three long, two deep.
std::vector<int> slot_beside(const SolidCase& solid) {
  const Patch& patch = solid.presses().patches[0];
  const double edge = mean_edge(solid.mesh());
  const Eigen::Vector3d side = patch.inward.unitOrthogonal(), along = patch.inward.cross(side);
  std::vector<int> slot;
  for (int t = 0; t < static_cast<int>(solid.mesh().tetrahedra.size()); ++t) {
    const auto& tet = solid.mesh().tetrahedra[t];
    if (std::ranges::find_first_of(tet, solid.surface().triangles[patch.triangle], {}, {},
                                   [&](int n) { return solid.surface().node_number[n]; }) != tet.end())
      continue;
    Eigen::Vector3d x = -patch.point;
    for (const int n : tet) x += solid.mesh().nodes[n] / 4;
    if (std::abs(x.dot(side) - 1.5 * edge) < 0.75 * edge && std::abs(x.dot(along)) < 1.5 * edge &&
        x.dot(patch.inward) < 2 * edge)
      slot.push_back(t);
  }
  if (slot.empty()) throw std::runtime_error("there is no place for a slot beside the first patch");
  return slot;
}

/// Forces [N] that press the patch's corners.
Field load_on(const SolidCase& solid, double newton) {
  Field load(solid.mesh().nodes.size(), Eigen::Vector3d::Zero());
  const Patch& patch = solid.presses().patches[0];
  for (const int n : solid.surface().triangles[patch.triangle])
    load[solid.surface().node_number[n]] = newton / 3 * patch.inward;
  return load;
}

StaticProblem without(const SolidCase& solid, const std::vector<int>& slot) {
  StaticProblem left = solid.problem();
  left.mesh.tetrahedra.clear();
  left.materials.of_element.clear();
  for (int t = 0, next = 0; t < static_cast<int>(solid.mesh().tetrahedra.size()); ++t) {
    if (next < static_cast<int>(slot.size()) && slot[next] == t) {
      ++next;
      continue;
    }
    left.mesh.tetrahedra.push_back(solid.mesh().tetrahedra[t]);
    if (!solid.problem().materials.of_element.empty())
      left.materials.of_element.push_back(solid.problem().materials.of_element[t]);
  }
  DofMap dofs(left.mesh);
  for (int n = 0; n < dofs.nodes(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (dofs.index(n, axis) != DofMap::kUnused && solid.problem().dofs.index(n, axis) == DofMap::kFixed)
        dofs.fix(n, axis);
  dofs.number();
  left.dofs = dofs;
  return left;
}

/// Displacements per mesh node once the model rests.
Field rest_of(const Archive& archive, const Body& body, const std::vector<int>& slot, const Field& load,
              std::vector<double>& seconds) {
  Body damped = body;
  Dynamic& motion = motion_of(damped);
  motion.damping = std::max(60.0, motion.damping);
  const auto model = make_model(damped, elastic_mesh(archive));
  model->remove(slot);
  for (int n = 0; n < archive.surface.size(); ++n) model->set_load(n, load[archive.surface.node_number[n]]);
  const double step = 0.9 * max_step(motion.integrator, model->frequency_bound(), motion.damping);
  Field u(load.size(), Eigen::Vector3d::Zero());
  for (int round = 0; round < 400; ++round) {
    const auto times = time_steps(0, 100, [&](int) { model->step(step); });
    seconds.insert(seconds.end(), times.begin(), times.end());
    double change = 0, size = 0;
    for (int n = 0; n < archive.surface.size(); ++n) {
      Eigen::Vector3d& at = u[archive.surface.node_number[n]];
      change = std::max(change, (model->displacement(n) - at).norm());
      size = std::max(size, model->displacement(n).norm());
      at = model->displacement(n);
    }
    if (change < 1e-6 * size) break;
  }
  return u;
}

/// How far the load moves the places that it acts on: the inverse of a stiffness.
double give(const Field& load, const Field& u) {
  double sum = 0;
  for (std::size_t n = 0; n < load.size(); ++n) sum += load[n].dot(u[n]);
  return sum;
}

}  // namespace

Result rest_after_cut(const SolidCase& solid, const Body& body, Row row) {
  const auto slot = slot_beside(solid);
  const StaticProblem left = without(solid, slot);
  const Field unit = load_on(solid, 1);
  const Field uncut = solve_loads(solid.problem(), unit).displacement;
  // As much force as moves the patch by a tenth of the ball's radius.
  const double newton = 0.1 * solid.presses().radius / give(unit, uncut);
  const Field load = load_on(solid, newton);
  const Field fresh = solve_loads(left, load).displacement;
  Body alone = body;
  take_loads_off(*as<MovingSpec>(alone));
  const auto begin = std::chrono::steady_clock::now();
  const Archive archive = precompute_on(alone, solid.mesh());
  row.offline_s = seconds_since(begin);
  std::vector<double> seconds;
  const Field ours = rest_of(archive, alone, slot, load, seconds);
  const StepTime time = summarise(std::move(seconds));
  row.step_us_median = 1e6 * time.median;
  row.step_us_p99 = 1e6 * time.p99;
  row.reference = "cut_mesh";

  Result result;
  const auto add = [&](Row of, const Field& u) {
    of.err_u_rel = solid.errors().of_field(solid.at_surface(u), solid.at_surface(fresh));
    of.err_f_rel = give(load, fresh) / give(load, u) - 1;  // stiffness against the load
    of.err_f_rel = std::abs(of.err_f_rel);
    result.rows.push_back(of);
  };
  add(row, ours);
  Field stale = uncut;
  for (Eigen::Vector3d& u : stale) u *= newton;
  Row ignorant{row.scene, solid.name("quasi_static"), row.knob, "tensors that do not know of it"};
  ignorant.reference = "cut_mesh";
  add(ignorant, stale);
  result.notes.push_back({row.scene, row.method, row.knob, row.value,
                          fmt::format("{} of {} tetrahedra removed; time is that of one step of the integrator",
                                      slot.size(), solid.mesh().tetrahedra.size())});
  return result;
}

}  // namespace palpate::study
