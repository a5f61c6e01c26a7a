// RR3510 table 1, measured: what do the pre-computed quasi-static, the tensor-mass and the spring-mass model
// cost, and how near are they to the direct solve, before a cut, after it, on another mesh, and under a
// rotation? The corotational variant stands beside them. scripts/model_table.py makes docs/models.md's table
// of these rows.
#include <functional>

#include "bench/model_cases.hpp"
#include "bench/report.hpp"
#include "common/contact/held_points.hpp"
#include "common/dynamics/corotational.hpp"
#include "common/dynamics/spring_mass.hpp"
#include "common/dynamics/tensor_mass.hpp"
#include "common/fem/processor_blas.hpp"

namespace palpate::bench {
namespace {

constexpr Material kTissue{2e3, 0.45, 1000};

void row(std::string_view model, std::string_view metric, double value, std::string_view unit) {
  report("three_models", model, metric, value, unit);
}

/// Median time of a step [s] while the body swings under its weight; a row of it unless `bench` is empty.
template <class Model>
double step_time(const ElasticMesh& mesh, const std::string& bench, const std::string& name, int steps) {
  const double damping = 5;
  Model model(mesh, Integrator::rk4, damping);
  model.set_gravity({0, 0, -9.81});
  const double dt = 0.9 * max_step(Integrator::rk4, model.frequency_bound(), damping);
  Samples samples;
  samples.measure(steps / 10, steps, [&](int) { model.step(dt); });
  keep(model.displacement(mesh.nodes() - 1));
  if (!bench.empty()) report(bench, name, "steps_per_s", 1 / samples.median(), "1/s");
  return samples.median();
}

/// Time of a step in single precision, and the time it may stand for.
template <class Model>
void speed(std::string_view name, const std::string& bench, const ElasticMesh& mesh, int steps) {
  const double median = step_time<Model>(mesh, bench, "box760", steps);
  const double longest = max_step(Integrator::rk4, Model(mesh, Integrator::rk4, 5).frequency_bound(), 5);
  row(name, "step_p50", 1e6 * median, "us");
  row(name, "max_step", 1e6 * longest, "us");
  row(name, "times_real_time", longest / median, "1");
}

/// One contact held afresh and the visible surface superposed.
void speed_precomputed(const ElasticMesh& mesh, int steps) {
  QuasiStaticSpec body;
  body.name = "box";
  body.material = kTissue;
  body.fixed.emplace_back();
  for (int n = 0; n < mesh.nodes(); ++n)
    if (mesh.fixed[n][0]) body.fixed[0].where.indices.push_back(n);
  const Archive archive = precompute(body, {mesh.rest, mesh.tetrahedra, {}});
  const Compliance<double> touched(archive, Compliance<double>::Rows::touchable);
  const Compliance<float> shown(archive, Compliance<float>::Rows::surface);
  const CompliantResponse response(touched);
  HeldPoints held(response, 1);
  std::vector<float> u(shown.stride());
  const std::array hold{Hold::all};
  const std::array<Eigen::Vector3d, 1> normal{-Eigen::Vector3d::UnitZ()}, target{Eigen::Vector3d(0, 0, -0.002)};
  Samples samples;
  samples.measure(100, steps, [&](int i) {
    const int node = (i + 100) * 37 % archive.surface.touchable;
    std::array<double, 3> force{};
    held.clear();
    held.add({{node, node, node}, Eigen::Vector3d::UnitX()});
    held.solve(hold, normal, target, force.data());
    const std::array<const float*, 3> columns{shown.column(node, 0), shown.column(node, 1), shown.column(node, 2)};
    const std::array<float, 3> weight{static_cast<float>(force[0]), static_cast<float>(force[1]),
                                      static_cast<float>(force[2])};
    kernels::active().combine_f(columns.data(), weight.data(), 3, 3 * shown.row_nodes(), u.data());
    keep(u[0]);
  });
  row("precomputed", "step_p50", 1e6 * samples.median(), "us");
}

/// What a model answers to the load on one meshing, uncut or cut.
using Answer = std::function<Field(const LoadedSolid&, std::span<const int> cut)>;

void accuracy(std::string_view name, const Answer& answer) {
  for (const double poisson : {0.25, 0.45}) {
    const auto solid = make_loaded_solid(Meshing::five, {2e3, poisson, 1000});
    const Field field = answer(solid, {}), reference = direct_field(solid);
    const std::string at = poisson == 0.25 ? "nu025" : "nu045";
    row(name, "field_error_" + at, field_error(solid, field, reference), "1");
    row(name, "force_error_" + at, give(solid, reference) / give(solid, field) - 1, "1");
  }
}

void other_meshes(std::string_view name, const Answer& answer) {
  const Material material{2e3, 0.25, 1000};
  const auto solid = make_loaded_solid(Meshing::five, material);
  const double first = give(solid, answer(solid, {}));
  const std::pair<Meshing, std::string> meshings[] = {{Meshing::five_mirrored, "stiffness_mirrored"},
                                                      {Meshing::five_regular, "stiffness_regular"},
                                                      {Meshing::six, "stiffness_six"}};
  for (const auto& [meshing, metric] : meshings) {
    const auto other = make_loaded_solid(meshing, material);
    row(name, metric, first / give(other, answer(other, {})) - 1, "1");
  }
}

void after_cut(std::string_view name, const Answer& answer) {
  const Material material{2e3, 0.25, 1000};
  const auto solid = make_loaded_solid(Meshing::five, material);
  const auto cut = slot(solid.problem.mesh);
  const auto fresh = make_loaded_solid(without(solid.problem.mesh, cut), material);
  const Field reference = direct_field(fresh), field = answer(solid, cut);
  row(name, "cut_field_error", field_error(solid, field, reference), "1");
  row(name, "cut_stiffness_change", give(solid, answer(solid, {})) / give(solid, field) - 1, "1");
  if (name == "precomputed")
    row("direct", "cut_stiffness_change", give(solid, direct_field(solid)) / give(solid, reference) - 1, "1");
}

void questions(std::string_view name, const Answer& answer) {
  accuracy(name, answer);
  other_meshes(name, answer);
  after_cut(name, answer);
}

template <class Model>
Answer dynamic_answer() {
  return [](const LoadedSolid& solid, std::span<const int> cut) { return rest_field<Model>(solid, cut, 1e-7); };
}

void rotation() {
  const auto solid = make_loaded_solid(Meshing::five, {2e3, 0.25, 1000});
  row("precomputed", "false_force",
      false_force(solid.mesh,
                  [&](const Field& u) { return internal_force(solid.problem.mesh, solid.problem.materials, u); }),
      "1");
  row("tensor_mass", "false_force", false_force_of<TensorMass<double>>(solid.mesh), "1");
  row("spring_mass", "false_force", false_force_of<SpringMass<double>>(solid.mesh), "1");
  row("corotational", "false_force", false_force_of<Corotational<double>>(solid.mesh), "1");
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  palpate::use_blas_of_this_processor(argv);
  using namespace palpate;
  using namespace palpate::bench;
  const int steps = quick(argc, argv) ? 4000 : 40000;
  const ElasticMesh box = make_box760(kTissue);
  speed_precomputed(box, steps);
  speed<TensorMass<float>>("tensor_mass", "", box, steps);
  speed<SpringMass<float>>("spring_mass", "spring_mass_rk4", box, steps);
  speed<Corotational<float>>("corotational", "corotational_rk4", box, steps / 4);
  step_time<SpringMass<double>>(box, "spring_mass_rk4", "box760_double", steps);
  step_time<SpringMass<float>>(make_box10648(kTissue), "spring_mass_rk4", "box10648", steps / 10);
  questions("precomputed", [](const LoadedSolid& solid, std::span<const int>) { return superposed_field(solid); });
  questions("tensor_mass", dynamic_answer<TensorMass<double>>());
  questions("spring_mass", dynamic_answer<SpringMass<double>>());
  questions("corotational", dynamic_answer<Corotational<double>>());
  rotation();
}
