#include <gtest/gtest.h>

#include "bench/soft_boxes.hpp"
#include "common/dynamics/tensor_mass.hpp"
#include "tests/dynamics/dynamic_meshes.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// Gravity, a pull at the last node and a push in the middle.
std::vector<Vector3d> loads(const testing::DynamicBody& body, const DynamicModel& model, const Vector3d& gravity,
                            double force) {
  std::vector<Vector3d> load;
  for (int n = 0; n < model.nodes(); ++n) load.push_back(model.mass(n) * gravity);
  load.back() += force * Vector3d(0, 1, 2);
  load[body.mesh.rest.size() / 2] += force * Vector3d(-1, 0, 1);
  return load;
}

/// Steps under damping until the slowest motion has died away, and compares with the direct solve.
template <class Scalar>
double error_at_rest(const testing::DynamicBody& body, double damping, double seconds) {
  const Vector3d gravity(0.5, 0, -9.81);
  TensorMass<Scalar> model(body.mesh, Integrator::rk4, damping);
  const auto load = loads(body, model, gravity, 1e-3);
  model.set_gravity(gravity);
  for (int n = 0; n < model.nodes(); ++n) model.set_load(n, load[n] - model.mass(n) * gravity);
  const double h = 0.9 * max_step(Integrator::rk4, model.frequency_bound(), damping);
  for (int i = 0; i * h < seconds; ++i) model.step(h);
  std::vector<Vector3d> u;
  for (int n = 0; n < model.nodes(); ++n) u.push_back(model.displacement(n));
  return testing::relative_difference(u, solve_loads(body.problem, load).displacement);
}

testing::DynamicBody box(const ElasticMesh& mesh) {
  std::vector<int> held;
  for (int n = 0; n < mesh.nodes(); ++n)
    if (mesh.fixed[n][0]) held.push_back(n);
  return testing::make_dynamic({mesh.rest, mesh.tetrahedra, {}}, mesh.materials[0], {testing::fix_nodes(held)});
}

TEST(TensorMassAtRest, IsTheDirectSolution) {
  for (const Material& material : {Material{1e3, 0.3, 1000}, Material{2e3, 0.45, 1000}, Material{1e5, 0.49, 1100}}) {
    const auto body = testing::dynamic_block({6, 5, 4}, material);
    const double slowest = 1.5 / 0.04 * std::sqrt(material.young / material.density) / 2;  // [rad/s], about
    EXPECT_LT(error_at_rest<double>(body, 2 * slowest, 25 / slowest), 1e-6);
    EXPECT_LT(error_at_rest<float>(body, 2 * slowest, 25 / slowest), 1e-3);
  }
}

TEST(TensorMassAtRest, IsTheDirectSolutionForASlenderBeam) {
  const auto body = box(bench::make_box760({2e3, 0.45, 1000}));
  EXPECT_LT(error_at_rest<double>(body, 1, 50), 1e-6);
  EXPECT_LT(error_at_rest<float>(body, 1, 50), 1e-3);
}

TEST(TensorMassAtRest, IsTheDirectSolutionForALargeBox) {
  const auto body = box(bench::make_box10648({2e3, 0.45, 1000}));
  EXPECT_LT(error_at_rest<float>(body, 12, 2.5), 1e-3);
}

}  // namespace
}  // namespace palpate
