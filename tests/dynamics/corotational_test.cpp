#include "common/dynamics/corotational.hpp"

#include <numbers>

#include "common/geometry/nearest_rotation.hpp"
#include "tests/dynamics/model_checks.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::vector<Vector3d> deformed(const ElasticMesh& mesh, double angle, double noise, unsigned seed) {
  auto u = affine_field(mesh, rotation(angle, {1, -1, 2}), {0.1, 0.2, -0.1});
  const auto extra = random_field(u.size(), noise, seed);
  for (std::size_t n = 0; n < u.size(); ++n) u[n] += extra[n];
  return u;
}

TEST(Corotational, ForcesAreTheDerivativeOfTheEnergyOnEveryCodePath) {
  const ElasticMesh mesh = free_block({2, 2, 2});
  const std::string before(kernels::active().name);
  for (const kernels::Table* table : kernels::available()) {
    kernels::use(table->name);
    Corotational<double> model(mesh, Integrator::rk4, 0);
    set_field(model, deformed(mesh, 2.5, 1e-3, 4));
    expect_forces_from_energy(model, 1e-7, 1e-5);
    expect_balance(model, mesh, 1e-12);
  }
  kernels::use(before);
}

TEST(Corotational, RigidMotionGivesNoForce) {
  const ElasticMesh mesh = free_block({3, 3, 3});
  Corotational<double> model(mesh, Integrator::rk4, 0);
  Corotational<float> single(mesh, Integrator::rk4, 0);
  set_field(model, random_field(mesh.rest.size(), 1e-3, 4));
  const double reference = largest(force_field(model));  // strains of some 10 %
  for (const double angle : {0.01, std::numbers::pi / 6, 2.0, std::numbers::pi}) {
    const auto u = affine_field(mesh, rotation(angle, {1, 2, -1}), {0.03, -0.02, 0.01});
    set_field(model, u);
    set_field(single, u);
    EXPECT_LT(largest(force_field(model)), 1e-11 * reference) << angle;
    EXPECT_LT(largest(force_field(single)), 1e-4 * reference) << angle;
  }
}

TEST(Corotational, SmallDisplacementsGiveTheLinearForces) {
  const DynamicBody body = dynamic_block({3, 3, 3});
  ElasticMesh mesh = body.mesh;
  mesh.fixed.assign(mesh.rest.size(), {false, false, false});
  Corotational<double> model(mesh, Integrator::rk4, 0);
  double error[2];
  for (const int tenth : {0, 1}) {
    const auto u = random_field(mesh.rest.size(), tenth ? 1e-7 : 1e-6, 5);
    set_field(model, u);
    auto linear = internal_force(body.problem.mesh, body.problem.materials, u);
    for (auto& f : linear) f = -f;
    error[tenth] = relative_difference(force_field(model), linear);
  }
  EXPECT_LT(error[0], 1e-3);
  EXPECT_NEAR(error[0] / error[1], 10, 1);
}

TEST(Corotational, AnyDeformationHasAFiniteForce) {
  const ElasticMesh mesh = free_block({2, 2, 2});
  const Matrix3d turn = rotation(0.4, {1, 1, 0});
  std::vector<Matrix3d> maps = {Matrix3d::Zero(), -Matrix3d::Identity(), 1e-12 * turn, 1e6 * turn};
  for (const auto& d : {Vector3d(1, 1, 0), Vector3d(1, 0, 0), Vector3d(1, 1, -1), Vector3d(1, 0.5, -0.5),
                        Vector3d(2, 1e-4, -1e-4), Vector3d(1, 1e-9, 0)})
    maps.push_back(turn * d.asDiagonal() * turn.transpose());
  Corotational<double> model(mesh, Integrator::rk4, 0);
  Corotational<float> single(mesh, Integrator::rk4, 0);
  const std::string before(kernels::active().name);
  for (const kernels::Table* table : kernels::available()) {
    kernels::use(table->name);
    for (const Matrix3d& a : maps) {
      // Every element's P is known from the rotation found by singular values.
      const Matrix3d r = nearest_rotation(a).rotation;
      EXPECT_NEAR(r.determinant(), 1, 1e-12);
      set_field(model, affine_field(mesh, a));
      set_field(single, affine_field(mesh, a));
      for (int n = 0; n < mesh.nodes(); ++n) {
        EXPECT_TRUE(model.elastic_force(n).allFinite()) << a;
        EXPECT_TRUE(single.elastic_force(n).allFinite()) << a;
      }
      // No rotation does better than the nearest one, so that the energy is a minimum over rotations.
      for (const double angle : {-0.3, 0.2})
        EXPECT_GE((r.transpose() * a).trace() + 1e-9 * a.norm(),
                  ((rotation(angle, {1, 0, 1}) * r).transpose() * a).trace());
    }
  }
  kernels::use(before);
}

/// Forces of a homogeneous F by the definition, with the rotation from singular values.
std::vector<Vector3d> homogeneous_forces(const ElasticMesh& mesh, const Matrix3d& f) {
  const Matrix3d r = nearest_rotation(f).rotation;
  const Lame c = lame(mesh.materials[0]);
  const Matrix3d p = 2 * c.mu * (f - r) + c.lambda * ((r.transpose() * f).trace() - 3) * r;
  std::vector<Vector3d> force(mesh.rest.size(), Vector3d::Zero());
  for (const auto& [i, j, k, l] : mesh.tetrahedra) {
    const auto tet = tet_gradients({mesh.rest[i], mesh.rest[j], mesh.rest[k], mesh.rest[l]});
    int corner = 0;
    for (const int node : {i, j, k, l}) force[node] -= tet.volume * p * tet.gradient.row(corner++).transpose();
  }
  return force;
}

TEST(Corotational, FlatAndInvertedElementsFollowTheNearestRotation) {
  const ElasticMesh mesh = free_block({2, 2, 2});
  const Matrix3d turn = rotation(2.2, {1, 1, 0}), axes = rotation(0.7, {0, 1, 2});
  Corotational<double> model(mesh, Integrator::rk4, 0);
  Corotational<float> single(mesh, Integrator::rk4, 0);
  const std::string before(kernels::active().name);
  for (const kernels::Table* table : kernels::available()) {
    kernels::use(table->name);
    for (const auto& d : {Vector3d(1.2, 0.9, 1), Vector3d(1, 0.5, 0), Vector3d(1, 0.8, -0.3), Vector3d(1, 0.02, -0.01),
                          Vector3d(1, 0.01, 0.01), Vector3d(0.3, 3e-4, 1e-4), Vector3d(1, 4e-7, -1e-8)}) {
      const Matrix3d f = turn * axes * d.asDiagonal() * axes.transpose();
      set_field(model, affine_field(mesh, f));
      const auto expected = homogeneous_forces(mesh, f);
      EXPECT_LT(relative_difference(force_field(model), expected), 1e-7) << d.transpose();
      if (d[1] + d[2] < 1e-3) continue;  // single precision does not hold the small stretches
      set_field(single, affine_field(mesh, f));
      EXPECT_LT(relative_difference(force_field(single), expected), 1e-2) << d.transpose();
    }
  }
  kernels::use(before);
}

TEST(Corotational, InvertedElementsArePushedBack) {
  const ElasticMesh mesh = free_block({2, 2, 2});
  Corotational<double> model(mesh, Integrator::rk4, 30);
  Matrix3d mirror = Matrix3d::Identity();
  mirror(2, 2) = -0.3;
  set_field(model, affine_field(mesh, mirror));
  const double dt = 0.5 * max_step(Integrator::rk4, model.frequency_bound(), 30);
  const double begin = model.energy();
  for (int i = 0; i < 20000; ++i) model.step(dt);
  EXPECT_LT(model.energy(), 1e-3 * begin);
}

TEST(Corotational, NoModeExceedsTheLinearBoundWhenTurnedAndStrained) {
  const ElasticMesh mesh = free_block({2, 2, 2});
  Corotational<double> model(mesh, Integrator::rk4, 0);
  const double bound = model.frequency_bound();
  for (const double angle : {0.0, 1.0, 3.0})
    for (const double stretch : {0.8, 1.0, 1.15}) {
      Matrix3d a = Matrix3d::Identity();
      a(0, 0) = stretch;
      set_field(model, affine_field(mesh, rotation(angle, {1, 2, 3}) * a));
      const double mode = stiffest_mode(model);
      EXPECT_LT(mode, bound * bound);
      EXPECT_GT(mode, 0.2 * bound * bound);
    }
}

/// A beam along x, clamped at x = 0, under a force at its far end.
DynamicBody beam() {
  return make_dynamic(make_block({0, 0, 0}, {0.16, 0.02, 0.02}, {16, 2, 2}), {1e4, 0.3, 1000}, {fix_group("x0")});
}

std::vector<Vector3d> settled_beam(const DynamicBody& body, const std::vector<Vector3d>& load) {
  const double damping = 12;
  Corotational<double> model(body.mesh, Integrator::rk4, damping);
  for (int n = 0; n < model.nodes(); ++n) model.set_load(n, load[n]);
  settle(model, 0.95 * max_step(Integrator::rk4, model.frequency_bound(), damping), 9000);
  return displacement_field(model);
}

TEST(Corotational, LightBendingIsTheLinearOneAndHeavyBendingKeepsTheLength) {
  const DynamicBody body = beam();
  const auto& group = body.problem.mesh.groups.at("x1").nodes;
  for (const bool heavy : {false, true}) {
    std::vector<Vector3d> load(body.mesh.rest.size(), Vector3d::Zero());
    for (const int n : group) load[n].z() = -(heavy ? 2e-2 : 2e-5) / group.size();
    const auto linear = solve_loads(body.problem, load).displacement;
    const auto bent = settled_beam(body, load);
    const int tip = group[group.size() / 2];
    if (!heavy) {
      EXPECT_LT(relative_difference(bent, linear), 2e-3);
      continue;
    }
    const double length = 0.16;
    EXPECT_GT(-linear[tip].z(), 0.5 * length);
    EXPECT_LT(-bent[tip].z(), 0.95 * -linear[tip].z());
    // The middle line keeps its length, where the linear one is as long as the hypotenuse.
    double line = 0;
    Vector3d last = Vector3d::Zero();
    for (int i = 0; i <= 16; ++i) {
      const int node = (1 * 3 + 1) * 17 + i;
      const Vector3d place = body.mesh.rest[node] + bent[node];
      if (i > 0) line += (place - last).norm();
      last = place;
    }
    EXPECT_NEAR(line, length, 0.02 * length);
  }
}

TEST(Corotational, TumblingFreePartKeepsEnergyAndMomentumForTenSeconds) {
  const ElasticMesh mesh = free_block({1, 1, 3}, {1e4, 0.3, 1000});
  Corotational<double> model(mesh, Integrator::rk4, 0);
  Vector3d centre = Vector3d::Zero();
  double mass = 0;
  for (int n = 0; n < mesh.nodes(); ++n) centre += model.mass(n) * mesh.rest[n], mass += model.mass(n);
  centre /= mass;
  const Vector3d spin(6, 3, 1);
  for (int n = 0; n < mesh.nodes(); ++n) model.set_motion(n, Vector3d::Zero(), spin.cross(mesh.rest[n] - centre));
  const auto momentum = [&] {
    Vector3d sum = Vector3d::Zero();
    for (int n = 0; n < mesh.nodes(); ++n)
      sum += model.mass(n) * (mesh.rest[n] + model.displacement(n) - centre).cross(model.velocity(n));
    return sum;
  };
  const double energy = model.energy();
  const Vector3d begin = momentum();
  const double dt = 0.4 * max_step(Integrator::rk4, model.frequency_bound(), 0);
  double turned = 0;
  for (double time = 0; time < 10; time += dt) {
    model.step(dt);
    turned = std::max(turned, (model.displacement(0)).norm());
    ASSERT_LT(model.energy(), 1.001 * energy) << time;
  }
  EXPECT_GT(model.energy(), 0.97 * energy);
  EXPECT_LT((momentum() - begin).norm(), 1e-3 * begin.norm());
  EXPECT_GT(turned, 0.02);
}

TEST(Corotational, RemovalLeavesTheModelOfTheRest) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    expect_removal_as_built_afresh<Corotational<double>>(free_block({4, 3, 3}), seed);
    expect_removal_as_built_afresh<Corotational<float>>(free_block({4, 3, 3}), seed);
  }
}

TEST(Corotational, StepAndRemovalTakeNoMemory) {
  const ElasticMesh mesh = free_block({3, 3, 3});
  Corotational<float> model(mesh, Integrator::semi_implicit, 1);
  const auto removed = random_tetrahedra(mesh, 0.2, 3);
  const long before = allocations();
  model.step(1e-4);
  model.remove(removed);
  model.step(1e-4);
  EXPECT_EQ(allocations(), before);
}

}  // namespace
}  // namespace palpate::testing
