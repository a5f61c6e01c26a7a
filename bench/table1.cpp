// TVCG99 table 1, measured: the time to deform a liver of 1,400 nodes under one contact, by solving the whole system
// ("normal": here one sparse factorisation and solve) and from precomputed tensors ("accelerated"), with linear
// elasticity and with the quasi non-linear correction. The paper: 15 s and 7 ms, over 50 s and 8 ms. Conjugate
// gradients, which the paper solves by, stand in the rows of bench_precompute.
#include <Eigen/Dense>

#include "bench/report.hpp"
#include "common/contact/held_points.hpp"
#include "common/fem/direct.hpp"
#include "common/fem/processor_blas.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/quasi_static/nonlinear.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/sim/deformer.hpp"

namespace palpate {
namespace {

const Eigen::Vector3d imposed(0, 0, -0.005);  // [m] at the contact

/// The touchable node that lies highest.
int top_node(const Archive& archive) {
  int top = 0;
  for (int n = 1; n < archive.surface.touchable; ++n)
    if (archive.surface.position[n].z() > archive.surface.position[top].z()) top = n;
  return top;
}

void measure(const std::string& scene_file, const std::string& name, bool quick) {
  const Scene scene = load_scene(scene_file);
  const std::vector<Archive> archives = load_or_precompute(scene, ArchivePart::surface);
  const auto& body = std::get<QuasiStaticSpec>(scene.bodies[0]);
  const int contact = top_node(archives[0]);

  const StaticProblem problem = make_static_problem(body, load_tet_mesh(body.mesh, body.scale));
  std::optional<QuasiNonlinear> correction;
  if (body.nonlinear) correction = make_nonlinear(body, archives[0]).at(archives[0].surface.position[contact]);
  std::vector<Constraint> holds;
  for (int axis = 0; axis < 3; ++axis)
    holds.push_back(hold(archives[0].surface.node_number[contact], axis, imposed[axis]));
  bench::Samples normal;
  normal.measure(1, quick ? 3 : 9, [&](int) {
    StaticSolution solution = solve_direct(problem, holds);
    if (correction)
      for (Eigen::Vector3d& u : solution.displacement) u = correction->correct(u, imposed.normalized());
    bench::keep(solution);
  });
  bench::report("table1", name, "normal", 1e3 * normal.median(), "ms");

  const Compliance<double> compliance(archives[0], Compliance<double>::Rows::touchable);
  const CompliantResponse response(compliance);
  HeldPoints held(response, 4);
  Deformer deformer(scene, archives);
  const std::array hold_all{Hold::all};
  const std::array normals{Eigen::Vector3d(-Eigen::Vector3d::UnitZ())}, target{imposed};
  bench::Samples accelerated;
  accelerated.measure(20, quick ? 200 : 2000, [&](int) {
    held.clear();
    held.add({{contact, contact, contact}, Eigen::Vector3d::UnitX()});
    std::array<double, 3> force{};
    held.solve(hold_all, normals, target, force.data());
    ContactState state{.run = 1};
    state.forces.push_back({0, static_cast<std::uint32_t>(contact), force});
    HeldContact held_contact{.normal = {0, 0, -1}, .force = force};
    state.contacts.push_back(held_contact);
    deformer.take(state);
    deformer.deform();
  });
  bench::report("table1", name, "accelerated", 1e3 * accelerated.median(), "ms");
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::use_blas_of_this_processor(argv);
  const bool quick = palpate::bench::quick(argc, argv);
  palpate::measure(PALPATE_SCENES "/liver.toml", "liver1400_linear", quick);
  palpate::measure(PALPATE_SCENES "/liver_nonlinear.toml", "liver1400_quasi_nonlinear", quick);
}
