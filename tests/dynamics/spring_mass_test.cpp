#include "common/dynamics/spring_mass.hpp"

#include <numbers>

#include "tests/dynamics/model_checks.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// One regular tetrahedron with edges of length 1 m and springs of `stiffness`.
ElasticMesh regular_tetrahedron(double stiffness, double density) {
  const double r = 1 / std::sqrt(8.0);
  const std::vector<Vector3d> rest = {{r, r, r}, {r, -r, -r}, {-r, r, -r}, {-r, -r, r}};
  const double volume = 1 / (6 * std::sqrt(2.0));
  return {rest, {{1, 0, 2, 3}}, {4, {false, false, false}}, {{stiffness / volume, 0.3, density}}, {}};
}

TEST(SpringMass, StiffnessOfAnEdgeIsYoungTimesVolumeOverLengthSquared) {
  const ElasticMesh mesh = regular_tetrahedron(7, 1000);
  const SpringMass<double> model(mesh, Integrator::rk4, 0);
  ASSERT_EQ(model.springs(), 6);
  for (int s = 0; s < 6; ++s) EXPECT_NEAR(model.stiffness(s), 7, 1e-12);
}

TEST(SpringMass, ForcesAreThoseOfThePaperOnEveryCodePath) {
  const ElasticMesh mesh = free_block({3, 2, 3});
  SpringMass<double> model(mesh, Integrator::rk4, 0);
  const std::string before(kernels::active().name);
  for (const kernels::Table* table : kernels::available()) {
    kernels::use(table->name);
    set_field(model, random_field(mesh.rest.size(), 4e-3, 5));
    std::vector<Vector3d> expected(mesh.rest.size(), Vector3d::Zero());
    for (int s = 0; s < model.springs(); ++s) {
      const auto [i, j] = model.ends(s);
      const Vector3d p = mesh.rest[j] + model.displacement(j) - mesh.rest[i] - model.displacement(i);
      const double rest = (mesh.rest[j] - mesh.rest[i]).norm();
      const Vector3d force = model.stiffness(s) * (p.norm() - rest) * p / p.norm();
      expected[i] += force, expected[j] -= force;
    }
    EXPECT_LT(relative_difference(force_field(model), expected), 1e-13) << table->name;
  }
  kernels::use(before);
}

TEST(SpringMass, ForcesAreTheDerivativeOfTheEnergyAndBalance) {
  const ElasticMesh mesh = free_block({2, 2, 3});
  SpringMass<double> model(mesh, Integrator::rk4, 0);
  set_field(model, random_field(mesh.rest.size(), 3e-3, 6));
  expect_forces_from_energy(model, 1e-7, 1e-5);
  expect_balance(model, mesh, 1e-13);
}

TEST(SpringMass, RigidMotionGivesNoForce) {
  const ElasticMesh mesh = free_block({3, 3, 3});
  SpringMass<double> model(mesh, Integrator::rk4, 0);
  set_field(model, random_field(mesh.rest.size(), 1e-3, 7));
  const double reference = largest(force_field(model));
  for (const double angle : {0.01, std::numbers::pi / 6, 3.1}) {
    set_field(model, affine_field(mesh, rotation(angle, {1, 2, -1}), {0.3, -0.2, 0.1}));
    EXPECT_LT(largest(force_field(model)), 1e-11 * reference) << angle;
  }
}

TEST(SpringMass, RegularTetrahedronBreathesAtTheFrequencyBound) {
  const double k = 40, density = 500;
  SpringMass<double> model(regular_tetrahedron(k, density), Integrator::rk4, 0);
  const double omega = std::sqrt(4 * k / model.mass(0));
  EXPECT_NEAR(model.frequency_bound(), omega, 1e-9 * omega);
  const ElasticMesh mesh = regular_tetrahedron(k, density);
  for (int n = 0; n < 4; ++n) model.set_motion(n, 1e-5 * mesh.rest[n], Vector3d::Zero());
  const int steps = 400;
  for (int i = 0; i < steps; ++i) model.step(2 * std::numbers::pi / omega / steps);
  for (int n = 0; n < 4; ++n) EXPECT_LT((model.displacement(n) - 1e-5 * mesh.rest[n]).norm(), 1e-8);
}

TEST(SpringMass, NoModeExceedsTheBoundUnderAnyStretch) {
  const ElasticMesh mesh = free_block({2, 2, 2});
  SpringMass<double> model(mesh, Integrator::rk4, 0);
  const double bound = model.frequency_bound();
  for (const double stretch : {0.7, 1.0, 1.5, 4.0}) {
    Matrix3d a = Matrix3d::Identity();
    a(0, 0) = stretch, a(1, 1) = 0.5 + 0.5 * stretch;
    set_field(model, affine_field(mesh, rotation(1, {0, 1, 1}) * a));
    const double mode = stiffest_mode(model);
    EXPECT_LT(mode, bound * bound) << stretch;
    if (stretch >= 1) {
      EXPECT_GT(mode, 0.1 * bound * bound) << stretch;
    }
  }
}

TEST(SpringMass, StableAtTheLargestStepAndUnstableBeyondIt) {
  const ElasticMesh mesh = regular_tetrahedron(40, 500);
  for (const Integrator integrator : {Integrator::rk4, Integrator::semi_implicit}) {
    double size[2];
    for (const int beyond : {0, 1}) {
      SpringMass<double> model(mesh, integrator, 0);
      const double dt = (beyond ? 1.05 : 0.98) * max_step(integrator, model.frequency_bound(), 0);
      for (int n = 0; n < 4; ++n) model.set_motion(n, 1e-6 * mesh.rest[n], Vector3d::Zero());
      double largest = 0;
      for (int i = 0; i < 200; ++i) {
        model.step(dt);
        largest = std::max(largest, model.displacement(0).norm());
      }
      size[beyond] = largest;
    }
    EXPECT_LT(size[0], 1e-5);
    EXPECT_GT(size[1], 1e-2);
  }
}

TEST(SpringMass, UndampedMotionKeepsItsEnergyToTheIntegratorsOrder) {
  const ElasticMesh mesh = free_block({2, 2, 2});
  double loss[2];
  for (const int half : {0, 1}) {
    SpringMass<double> model(mesh, Integrator::rk4, 0);
    set_field(model, random_field(mesh.rest.size(), 1e-4, 8));
    const double begin = model.energy();
    const double dt = (half ? 0.25 : 0.5) / model.frequency_bound();
    for (int i = 0; i < (half ? 800 : 400); ++i) model.step(dt);
    loss[half] = std::abs(model.energy() / begin - 1);
  }
  EXPECT_LT(loss[0], 0.02);
  EXPECT_GT(loss[0] / loss[1], 20);  // RK4 loses energy as dt^5
}

TEST(SpringMass, RemovalLeavesTheModelOfTheRest) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    expect_removal_as_built_afresh<SpringMass<double>>(free_block({4, 3, 3}), seed);
    expect_removal_as_built_afresh<SpringMass<float>>(free_block({4, 3, 3}), seed);
  }
}

TEST(SpringMass, SpringsWithoutTetrahedraVanishAndNodesLeave) {
  const ElasticMesh mesh = free_block({1, 1, 2});
  SpringMass<double> model(mesh, Integrator::rk4, 0);
  model.set_gravity({0, 0, -9.81});
  std::vector<int> all;
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t) all.push_back(t);
  for (int i = 0; i < 10; ++i) model.step(1e-4);
  model.remove(std::span(all).first(all.size() / 2));
  int left = 0;
  for (int n = 0; n < mesh.nodes(); ++n)
    if (model.mass(n) == 0) {
      ++left;
      const Vector3d place = model.displacement(n);
      model.step(1e-4);
      EXPECT_EQ(model.velocity(n), Vector3d::Zero());
      EXPECT_EQ(model.displacement(n), place);
    }
  EXPECT_EQ(left, 4);
  model.remove(all);
  model.step(1e-4);
  EXPECT_EQ(model.frequency_bound(), 0);
  for (int s = 0; s < model.springs(); ++s) EXPECT_EQ(model.stiffness(s), 0);
}

TEST(SpringMass, StepAndRemovalTakeNoMemory) {
  const ElasticMesh mesh = free_block({3, 3, 3});
  SpringMass<float> model(mesh, Integrator::rk4, 1);
  const auto removed = random_tetrahedra(mesh, 0.2, 3);
  const long before = allocations();
  model.step(1e-4);
  model.remove(removed);
  model.step(1e-4);
  const Vector3d force = model.elastic_force(3);
  EXPECT_EQ(allocations(), before);
  EXPECT_TRUE(force.allFinite());
}

TEST(SpringMass, FixedAxesStandStillAndStateRestoresTheMotion) {
  const DynamicBody body = dynamic_block({2, 2, 2});
  SpringMass<float> first(body.mesh, Integrator::semi_implicit, 2), second(body.mesh, Integrator::semi_implicit, 2);
  for (auto* model : {&first, &second}) model->set_gravity({1, 0, -9.81});
  for (int i = 0; i < 50; ++i) first.step(1e-4);
  second.restore(testing::saved(first).data());
  for (int i = 0; i < 50; ++i) first.step(1e-4), second.step(1e-4);
  EXPECT_EQ(testing::saved(first), testing::saved(second));
  for (int n = 0; n < body.mesh.nodes(); ++n) {
    if (body.mesh.fixed[n][2]) {
      EXPECT_EQ(first.displacement(n), Vector3d::Zero());
    } else {
      EXPECT_NE(first.displacement(n), Vector3d::Zero());
    }
  }
}

class Anchor : public Coupling {
 public:
  explicit Anchor(double stiffness) : stiffness_(stiffness) {}
  void apply(const double* u, double* force) override {
    for (int a = 0; a < 3; ++a) force[a] -= stiffness_ * u[a];
  }

 private:
  double stiffness_;
};

TEST(SpringMass, CoupledNodesFeelTheOthersForceInEveryStage) {
  const DynamicBody body = dynamic_block({2, 2, 2});
  const int node = body.mesh.nodes() - 1;
  const double stiffness = 50, mass = 1e-3;
  Anchor anchor(stiffness);
  SpringMass<double> model(body.mesh, Integrator::rk4, 60);
  const double own = model.mass(node), alone = model.frequency_bound();
  model.couple(&anchor, std::span(&node, 1), std::span(&mass, 1), stiffness / mass);
  EXPECT_DOUBLE_EQ(model.mass(node), own + mass);
  EXPECT_DOUBLE_EQ(model.frequency_bound(), std::max(alone, std::sqrt(stiffness / mass)));
  model.set_load(node, {0.01, 0, -0.02});
  settle(model, 0.9 * max_step(Integrator::rk4, model.frequency_bound(), 60), 3000);
  const Vector3d residual = model.load(node) + model.elastic_force(node) - stiffness * model.displacement(node);
  EXPECT_LT(residual.norm(), 1e-6 * model.load(node).norm());
  EXPECT_GT(model.displacement(node).norm(), 1e-5);
  model.couple(nullptr, {}, {}, 0);
  EXPECT_DOUBLE_EQ(model.mass(node), own);
  EXPECT_DOUBLE_EQ(model.frequency_bound(), alone);
}

TEST(SpringMass, MeshWithAFlatTetrahedronIsRefused) {
  ElasticMesh mesh = regular_tetrahedron(1, 1000);
  mesh.rest[3] = mesh.rest[2];
  EXPECT_THROW(SpringMass<double>(mesh, Integrator::rk4, 0), std::runtime_error);
}

}  // namespace
}  // namespace palpate::testing
