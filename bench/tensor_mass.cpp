// How many RK4 steps a second does the tensor-mass model take on one core, and how many times as many as the
// textbook loop over the elements in the same run? What does a step of elements with averaged strain cost beside it?
#include "common/dynamics/tensor_mass.hpp"

#include <fmt/format.h>

#include "bench/element_loop.hpp"
#include "bench/report.hpp"
#include "bench/soft_boxes.hpp"
#include "common/dynamics/nodal_strain.hpp"

namespace palpate {
namespace {

constexpr Material kTissue{2e3, 0.45, 1000};
constexpr double kDamping = 5;  // [1/s]
const Eigen::Vector3d kGravity(0, 0, -9.81);

/// Median time of a step [s], its rows reported.
template <class Model>
double measure(const ElasticMesh& mesh, const std::string& model, const std::string& name, int steps) {
  Model tissue(mesh, Integrator::rk4, kDamping);
  tissue.set_gravity(kGravity);
  const double dt = 0.9 * max_step(Integrator::rk4, tissue.frequency_bound(), kDamping);
  bench::Samples samples;
  samples.measure(steps / 10, steps, [&](int) { tissue.step(dt); });
  bench::keep(tissue.displacement(mesh.nodes() - 1));
  bench::report(model, name, "steps_per_s", 1 / samples.median(), "1/s");
  bench::report(model, name, "p50", 1e6 * samples.median(), "us");
  bench::report(model, name, "p99", 1e6 * samples.p99(), "us");
  return samples.median();
}

template <class Scalar>
void compare(const ElasticMesh& mesh, const std::string& name, int steps) {
  const double tensors = measure<TensorMass<Scalar>>(mesh, "tensor_mass_rk4", name, steps);
  const double averaged = measure<NodalStrain<Scalar>>(mesh, "nodal_strain_rk4", name, steps);
  bench::report("nodal_strain_rk4", name, "over_tensor_mass", averaged / tensors, "1");
  bench::ElementLoop<Scalar> loop(mesh, kDamping, kGravity);
  const double dt = 1e-5;
  bench::Samples samples;
  samples.measure(steps / 100, steps / 10, [&](int) { loop.step(dt); });
  bench::keep(loop.displacement(mesh.nodes() - 1));
  bench::report("tensor_mass_rk4", name, "elements_p50", 1e6 * samples.median(), "us");
  bench::report("tensor_mass_rk4", name, "speedup_over_elements", samples.median() / tensors, "1");
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  using namespace palpate;
  const int steps = bench::quick(argc, argv) ? 4000 : 40000;
  const ElasticMesh small = bench::make_box760(kTissue), large = bench::make_box10648(kTissue);
  compare<float>(small, "box760", steps);
  compare<double>(small, "box760_double", steps);
  compare<float>(large, "box10648", steps / 10);
  compare<double>(large, "box10648_double", steps / 10);
}
