// RR3510 sec. 5.4: Runge-Kutta "allows the use of larger time steps, about ten times larger, than the Euler
// method" and is "about two" times as fast. Here for RK4, semi-implicit Euler and forward Euler (damped, as
// it must be): the largest stable step, measured by growth, and the wall time per simulated second when each
// takes the largest step whose trajectory stays within 1e-3 of a reference. A cube of tissue that hangs on
// one face is let go under gravity, for about one swing of its slowest mode, whose frequency is also the
// damping.
#include <cmath>

#include "bench/report.hpp"
#include "bench/soft_boxes.hpp"
#include "common/dynamics/tensor_mass.hpp"

namespace palpate {
namespace {

using Field = std::vector<Eigen::Vector3d>;

constexpr int kSamples = 20;
const Eigen::Vector3d kGravity(0, 0, -9.81);

/// A cube of so many cells of 5 mm along each edge, and times in proportion to its slowest swing.
struct Case {
  Case(std::string which, double young, int cells)
      : name(std::move(which)), mesh(bench::make_soft_box({cells, cells, cells}, {young, 0.45, 1000})) {
    const double shear = std::sqrt(young / (2 * 1.45) / 1000), slowest = 1.57 * shear / (0.005 * cells);
    damping = slowest;
    interval = 2 * 3.14159 / slowest / kSamples;
  }
  std::string name;
  ElasticMesh mesh;
  double damping;   // [1/s]
  double interval;  // [s] between two samples of the trajectory
};

Field shape(const DynamicModel& model) {
  Field u;
  for (int n = 0; n < model.nodes(); ++n) u.push_back(model.displacement(n));
  return u;
}

/// The fastest mode: beyond RK4's limit it outgrows all others.
Field fastest_mode(const Case& c) {
  TensorMass<double> model(c.mesh, Integrator::rk4, 0);
  for (int n = 0; n < model.nodes(); ++n)
    model.set_motion(n, 1e-3 * Eigen::Vector3d(n % 3 - 1, n % 5 - 2, n % 7 - 3), {0, 0, 0});
  const double limit = max_step(Integrator::rk4, model.frequency_bound(), 0);
  for (double size = 0, h = limit; size < 1e50; h *= 1.05) {
    for (int i = 0; i < 200; ++i) model.step(h);
    size = 0;
    for (const auto& u : shape(model)) size = std::max(size, u.norm());
  }
  Field mode = shape(model);
  double size = 0;
  for (const auto& u : mode) size = std::max(size, u.norm());
  for (auto& u : mode) u *= 1e-4 / size;
  return mode;
}

bool grows(const Case& c, const Field& mode, Integrator integrator, double h) {
  TensorMass<double> model(c.mesh, integrator, c.damping);
  for (int n = 0; n < model.nodes(); ++n) model.set_motion(n, mode[n], {0, 0, 0});
  const double before = model.energy();
  for (int i = 0; i < 20000; ++i) model.step(h);
  return !(model.energy() < before);
}

double max_stable_step(const Case& c, const Field& mode, Integrator integrator) {
  const double bound = TensorMass<double>(c.mesh, integrator, 0).frequency_bound();
  double stable = max_step(integrator, bound, c.damping), growing = 4 * stable;
  for (int i = 0; i < 9; ++i) {
    const double middle = 0.5 * (stable + growing);
    (grows(c, mode, integrator, middle) ? growing : stable) = middle;
  }
  return stable;
}

/// Displacements of all nodes at each sample, with so many steps in between.
template <class Scalar>
std::vector<Field> trajectory(const Case& c, Integrator integrator, int steps) {
  TensorMass<Scalar> model(c.mesh, integrator, c.damping);
  model.set_gravity(kGravity);
  std::vector<Field> samples;
  for (int s = 0; s < kSamples; ++s) {
    for (int i = 0; i < steps; ++i) model.step(c.interval / steps);
    samples.push_back(shape(model));
  }
  return samples;
}

/// Largest difference over the largest displacement.
double error(const std::vector<Field>& samples, const std::vector<Field>& reference) {
  double difference = 0, size = 0;
  for (std::size_t s = 0; s < samples.size(); ++s)
    for (std::size_t n = 0; n < samples[s].size(); ++n) {
      const double d = (samples[s][n] - reference[s][n]).norm();
      if (!(d <= 1e30)) return 1e30;
      difference = std::max(difference, d);
      size = std::max(size, reference[s][n].norm());
    }
  return difference / size;
}

/// The fewest steps per interval, at least `fewest`, that keep the error.
int steps_within(const Case& c, Integrator integrator, const std::vector<Field>& reference, int fewest) {
  const auto good = [&](int steps) { return error(trajectory<float>(c, integrator, steps), reference) <= 1e-3; };
  int bad = fewest - 1, enough = fewest;
  while (!good(enough)) bad = enough, enough *= 2;
  while (enough - bad > std::max(1, bad / 50)) {
    const int middle = (bad + enough) / 2;
    (good(middle) ? enough : bad) = middle;
  }
  return enough;
}

/// Median time of a step [s] in single precision.
double step_time(const Case& c, Integrator integrator) {
  TensorMass<float> model(c.mesh, integrator, c.damping);
  model.set_gravity(kGravity);
  const double h = 0.5 * max_step(integrator, model.frequency_bound(), c.damping);
  bench::Samples samples;
  samples.measure(500, 5000, [&](int) { model.step(h); });
  return samples.median();
}

struct Result {
  double step, wall;
};

Result measure(const Case& c, const std::string& name, Integrator integrator, const Field& mode,
               const std::vector<Field>& reference) {
  Result result;
  result.step = max_stable_step(c, mode, integrator);
  const int steps = steps_within(c, integrator, reference, static_cast<int>(std::ceil(c.interval / result.step)));
  result.wall = step_time(c, integrator) * steps / c.interval;
  const std::string row = c.name + "_" + name;
  bench::report("integrators", row, "max_step", 1e3 * result.step, "ms");
  const double bound = TensorMass<double>(c.mesh, integrator, 0).frequency_bound();
  bench::report("integrators", row, "step_from_bound", 1e3 * max_step(integrator, bound, c.damping), "ms");
  bench::report("integrators", row, "step_at_equal_error", 1e3 * c.interval / steps, "ms");
  bench::report("integrators", row, "wall_per_second", result.wall, "s");
  return result;
}

void compare(const Case& c) {
  const Field mode = fastest_mode(c);
  const double bound = TensorMass<double>(c.mesh, Integrator::rk4, 0).frequency_bound();
  const auto reference = trajectory<double>(
      c, Integrator::rk4, static_cast<int>(10 * c.interval / max_step(Integrator::rk4, bound, c.damping)) + 1);
  const Result rk4 = measure(c, "rk4", Integrator::rk4, mode, reference);
  const Result semi = measure(c, "semi_implicit", Integrator::semi_implicit, mode, reference);
  const Result forward = measure(c, "forward_euler", Integrator::forward_euler, mode, reference);
  bench::report("integrators", c.name + "_rk4", "step_over_semi_implicit", rk4.step / semi.step, "1");
  bench::report("integrators", c.name + "_rk4", "step_over_forward_euler", rk4.step / forward.step, "1");
  bench::report("integrators", c.name + "_rk4", "speedup_over_semi_implicit", semi.wall / rk4.wall, "1");
  bench::report("integrators", c.name + "_rk4", "speedup_over_forward_euler", forward.wall / rk4.wall, "1");
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  const bool quick = palpate::bench::quick(argc, argv);
  palpate::compare({"soft", 1e3, quick ? 4 : 8});
  if (!quick) palpate::compare({"stiff", 1e6, 8});  // the same in shorter steps
}
