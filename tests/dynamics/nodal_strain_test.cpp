#include "common/dynamics/nodal_strain.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "common/geometry/dense_solvers.hpp"
#include "common/mesh/cut_mesh.hpp"
#include "tests/dynamics/dynamic_meshes.hpp"
#include "tests/dynamics/model_checks.hpp"
#include "tests/dynamics/textbook.hpp"
#include "tests/tool/count_allocations.hpp"

/// Elements whose strain is averaged at their nodes, against the assembled matrix and by themselves.
namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::random_field;
using Field = std::vector<Vector3d>;

/// A jittered block on its bottom, of two materials where `layered`.
testing::DynamicBody averaged_block(const std::array<int, 3>& cells, const Material& material, bool layered) {
  testing::DynamicBody body = testing::dynamic_block(cells, material);
  MaterialField& materials = body.problem.materials;
  if (layered) {
    materials.materials.push_back({20 * material.young, 0.3, 1300});
    for (std::size_t t = 0; t < body.mesh.tetrahedra.size(); ++t) materials.of_element.push_back(t % 3 == 0);
  }
  materials.nodal_strain.assign(body.mesh.tetrahedra.size(), 1);
  body.mesh.materials = materials.materials;
  body.mesh.material_of = materials.of_element;
  return body;
}

template <class Scalar>
class NodalStrainOf : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(NodalStrainOf, Scalars);

/// The forces that one step from rest shows, and those of elastic_force().
TYPED_TEST(NodalStrainOf, ForceIsThatOfTheAssembledMatrix) {
  for (const bool layered : {false, true}) {
    const auto body = averaged_block({4, 3, 5}, {2e3, 0.45, 1000}, layered);
    NodalStrain<TypeParam> model(body.mesh, Integrator::semi_implicit, 0);
    testing::set_field(model, random_field(body.mesh.rest.size(), 1e-3, 3));
    const Field u = testing::displacement_field(model);
    Field expected = internal_force(body.problem.mesh, body.problem.materials, u);
    for (Vector3d& f : expected) f = -f;
    const double rounding = 100 * std::numeric_limits<TypeParam>::epsilon();
    EXPECT_LT(testing::relative_difference(testing::force_field(model), expected), rounding);
    const double h = 0x1p-10;
    model.step(h);
    Field in_step;
    for (int n = 0; n < model.nodes(); ++n) {
      in_step.push_back(model.velocity(n) * model.mass(n) / h);
      for (int axis = 0; axis < 3; ++axis)
        if (body.mesh.fixed[n][axis]) expected[n][axis] = 0;
    }
    EXPECT_LT(testing::relative_difference(in_step, expected), rounding);
  }
}

TEST(NodalStrain, MatrixAndForcesAreTheSame) {
  const auto body = averaged_block({3, 3, 3}, {2e3, 0.49, 1000}, true);
  const DofMap& dofs = body.problem.dofs;
  const auto stiffness = assemble_stiffness(body.problem.mesh, body.problem.materials, dofs);
  Field u = random_field(body.mesh.rest.size(), 1e-3, 5);
  Eigen::VectorXd x(dofs.size());
  for (std::size_t n = 0; n < u.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (!dofs.is_free(static_cast<int>(n), axis)) u[n][axis] = 0;
  for (int i = 0; i < dofs.size(); ++i) x[i] = u[dofs.dof(i) / 3][dofs.dof(i) % 3];
  const Eigen::VectorXd product = stiffness.selfadjointView<Eigen::Lower>() * x;
  const Field force = internal_force(body.problem.mesh, body.problem.materials, u);
  for (int i = 0; i < dofs.size(); ++i)
    ASSERT_NEAR(product[i], force[dofs.dof(i) / 3][dofs.dof(i) % 3], 1e-12 * product.cwiseAbs().maxCoeff());
}

TYPED_TEST(NodalStrainOf, ARigidTranslationGivesExactlyNoForce) {
  const ElasticMesh mesh = testing::free_block({3, 3, 3}, {1e4, 0.49, 1000});
  NodalStrain<TypeParam> model(mesh, Integrator::rk4, 0);
  testing::set_field(model, Field(mesh.rest.size(), Vector3d(0.1, -0.2, 0.3)));
  const Field u = testing::displacement_field(model);
  for (int n = 0; n < mesh.nodes(); ++n) EXPECT_EQ(model.elastic_force(n), Vector3d::Zero());
  for (int i = 0; i < 10; ++i) model.step(1e-4);
  EXPECT_EQ(testing::displacement_field(model), u);
}

TEST(NodalStrain, ASmallTurnGivesNoForceAndALinearFieldItsStress) {
  const Material material{1e4, 0.49, 1000};
  const ElasticMesh mesh = testing::free_block({4, 4, 4}, material);
  NodalStrain<double> model(mesh, Integrator::rk4, 0);
  Matrix3d turn;
  turn << 0, -1e-3, 2e-3, 1e-3, 0, -3e-3, -2e-3, 3e-3, 0;
  testing::set_field(model, testing::affine_field(mesh, Matrix3d::Identity() + turn));
  const double stiff = 1e4 * 0.01 * 0.01 * 1e-3;  // [N] of a strain of a thousandth
  EXPECT_LT(testing::largest(testing::force_field(model)), 1e-10 * stiff);
  EXPECT_LT(model.energy(), 1e-10 * stiff * 0.01);
  Matrix3d strain;
  strain << 1e-3, 2e-4, 0, 2e-4, -4e-4, 1e-4, 0, 1e-4, 5e-4;
  testing::set_field(model, testing::affine_field(mesh, Matrix3d::Identity() + strain));
  const Field expected = internal_force({mesh.rest, mesh.tetrahedra, {}}, {{material}, {}, {}},
                                        testing::displacement_field(model));  // of linear elements
  const Field force = testing::force_field(model);
  for (int n = 0; n < mesh.nodes(); ++n) EXPECT_LT((force[n] + expected[n]).norm(), 1e-9 * stiff) << n;
}

TEST(NodalStrain, ForcesAreBalancedAndComeFromTheEnergy) {
  const ElasticMesh mesh = testing::free_block({3, 4, 3}, {1e4, 0.49, 1000});
  NodalStrain<double> model(mesh, Integrator::rk4, 0);
  testing::set_field(model, random_field(mesh.rest.size(), 1e-5, 7));
  testing::expect_forces_from_energy(model, 1e-6, 1e-8);
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
  double size = 0;
  for (int n = 0; n < mesh.nodes(); ++n) {
    const Vector3d f = model.elastic_force(n);
    force += f, moment += mesh.rest[n].cross(f), size += f.norm();
  }
  EXPECT_LT(force.norm(), 1e-12 * size);
  EXPECT_LT(moment.norm(), 1e-12 * size * 0.04) << "about the rest shape, as of all that is linear";
}

/// With others' forces on some nodes, as a hybrid body has them.
TEST(NodalStrain, StepsAreThoseOfTheTextbook) {
  const auto body = averaged_block({3, 3, 4}, {2e3, 0.49, 1000}, false);
  testing::DenseCoupling coupling({40, 44, 47, 51}, 5);
  const std::vector<double> mass(coupling.nodes.size(), 2e-3);
  for (const Integrator integrator : {Integrator::rk4, Integrator::semi_implicit, Integrator::forward_euler}) {
    NodalStrain<double> model(body.mesh, integrator, 3);
    testing::Textbook textbook(body, integrator, 3);
    model.couple(&coupling, coupling.nodes, mass, 1e4);
    textbook.couple(coupling, mass);
    testing::set_field(model, random_field(body.mesh.rest.size(), 1e-4, 2));
    for (int n = 0; n < model.nodes(); ++n) {
      const Vector3d load = model.mass(n) * Vector3d(0, 1, -9.81);
      model.set_load(n, load);
      textbook.set(n, model.displacement(n), Vector3d::Zero(), load);
    }
    for (int step = 0; step < 20; ++step) model.step(1e-4), textbook.step(1e-4);
    EXPECT_LT(testing::relative_difference(testing::displacement_field(model), textbook.displacement()), 1e-11);
  }
}

TEST(NodalStrain, RemovalLeavesTheForcesOfTheRestToTheLastBit) {
  const auto body = averaged_block({5, 4, 5}, {2e3, 0.49, 1000}, true);
  NodalStrain<double> cut(body.mesh, Integrator::rk4, 0);
  const double bound = cut.frequency_bound();
  std::mt19937 random(4);
  CutMesh topology(body.mesh.tetrahedra, body.mesh.nodes());
  const Field u = random_field(body.mesh.rest.size(), 1e-3, 8);
  std::vector<int> removed;
  while (topology.alive_count() > 0) {
    removed.clear();
    for (int i = 0; i < 40 && topology.alive_count() > 0; ++i)
      topology.remove(static_cast<int>(random() % topology.size()), removed);
    const std::size_t before = allocations();
    cut.remove(removed);
    EXPECT_EQ(allocations(), before);
    ElasticMesh left = body.mesh;
    left.tetrahedra.clear(), left.material_of.clear();
    for (int t = 0; t < topology.size(); ++t)
      if (topology.alive(t))
        left.tetrahedra.push_back(body.mesh.tetrahedra[t]), left.material_of.push_back(body.mesh.material_of[t]);
    NodalStrain<double> fresh(left, Integrator::rk4, 0);
    EXPECT_LE(fresh.frequency_bound(), bound);
    EXPECT_EQ(cut.frequency_bound(), bound);
    testing::set_field(cut, u), testing::set_field(fresh, u);
    for (int n = 0; n < cut.nodes(); ++n) {
      ASSERT_EQ(cut.mass(n), fresh.mass(n));
      ASSERT_EQ(cut.elastic_force(n), fresh.elastic_force(n)) << n;
    }
  }
}

TEST(NodalStrain, AStepAllocatesNothing) {
  const auto body = averaged_block({3, 3, 3}, {2e3, 0.45, 1000}, true);
  NodalStrain<float> model(body.mesh, Integrator::rk4, 1);
  const std::size_t before = allocations();
  model.step(1e-4), model.step_semi_implicit(1e-4);
  EXPECT_EQ(allocations(), before);
}

double highest_frequency(const testing::DynamicBody& body) {
  const NodalStrain<double> lumped(body.mesh, Integrator::rk4, 0);
  const DofMap& dofs = body.problem.dofs;
  const Eigen::MatrixXd lower = assemble_stiffness(body.problem.mesh, body.problem.materials, dofs);
  Eigen::VectorXd scale(dofs.size());
  for (int i = 0; i < dofs.size(); ++i) scale[i] = 1 / std::sqrt(lumped.mass(dofs.dof(i) / 3));
  return std::sqrt(symmetric_eigenvalues(scale.asDiagonal() * lower * scale.asDiagonal()).maxCoeff());
}

TEST(NodalStrain, TheBoundLiesAboveTheHighestFrequencyAndKeepsItStable) {
  for (const double poisson : {-0.7, 0.0, 0.3, 0.49, 0.499})
    for (const bool layered : {false, true}) {
      const auto body = averaged_block({3, 3, 3}, {3e3, poisson, 1000}, layered);
      NodalStrain<double> model(body.mesh, Integrator::rk4, 0);
      EXPECT_GE(model.frequency_bound(), highest_frequency(body)) << poisson;
      EXPECT_LT(model.frequency_bound(), 6 * highest_frequency(body)) << poisson;
      testing::set_field(model, random_field(body.mesh.rest.size(), 1e-4, 4));
      const double before = model.energy(), h = 0.99 * max_step(Integrator::rk4, model.frequency_bound(), 0);
      for (int i = 0; i < 3000; ++i) model.step(h);
      EXPECT_LT(model.energy(), 1.01 * before) << poisson;
    }
}

/// Whole-node spurious motions would swing at nearly no frequency.
TEST(NodalStrain, AFreeBlockHasSixRigidMotionsAndNoOtherSoftOnes) {
  const ElasticMesh mesh = testing::free_block({3, 3, 3}, {1e4, 0.49, 1000});
  TetMesh tets{mesh.rest, mesh.tetrahedra, {}};
  DofMap dofs(tets);
  dofs.number();
  const MaterialField linear{mesh.materials, {}, {}},
      averaged{mesh.materials, {}, std::vector<char>(tets.tetrahedra.size(), 1)};
  const auto ascending = [&](const MaterialField& materials) {
    return Eigen::VectorXd(symmetric_eigenvalues(Eigen::MatrixXd(assemble_stiffness(tets, materials, dofs))));
  };
  const Eigen::VectorXd found = ascending(averaged), of_linear = ascending(linear);
  for (int i = 0; i < 6; ++i) EXPECT_LT(std::abs(found[i]), 1e-9 * found.maxCoeff());
  EXPECT_GT(found[6], 0.2 * of_linear[6]);
}

template <class Scalar>
double error_at_rest(const Material& material, double damping, double seconds) {
  const auto body = averaged_block({6, 5, 4}, material, true);
  NodalStrain<Scalar> model(body.mesh, Integrator::rk4, damping);
  const Vector3d gravity(0.5, 0, -9.81);
  model.set_gravity(gravity);
  Field load;
  for (int n = 0; n < model.nodes(); ++n) load.push_back(model.mass(n) * gravity);
  const double h = 0.9 * max_step(Integrator::rk4, model.frequency_bound(), damping);
  for (int i = 0; i * h < seconds; ++i) model.step(h);
  return testing::relative_difference(testing::displacement_field(model), solve_loads(body.problem, load).displacement);
}

TEST(NodalStrain, ComesToRestWhereTheDirectSolutionIs) {
  for (const Material& material : {Material{1e3, 0.3, 1000}, Material{2e3, 0.49, 1000}}) {
    const double slowest = 1.5 / 0.04 * std::sqrt(material.young / material.density) / 2;  // [rad/s], about
    EXPECT_LT(error_at_rest<double>(material, 2 * slowest, 25 / slowest), 1e-6);
    EXPECT_LT(error_at_rest<float>(material, 2 * slowest, 25 / slowest), 1e-3);
  }
}

}  // namespace
}  // namespace palpate
