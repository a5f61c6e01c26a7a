#include "common/dynamics/tensor_mass.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/dynamics/dynamic_meshes.hpp"
#include "tests/dynamics/model_checks.hpp"
#include "tests/dynamics/textbook.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::dynamic_block;
using testing::DynamicBody;
using testing::random_field;
using testing::Textbook;
using Field = std::vector<Vector3d>;

template <class Scalar>
class TensorMassOf : public ::testing::Test {
 public:
  /// What rounding alone may do to a sum of some ten terms.
  static constexpr double kRounding = 50 * std::numeric_limits<Scalar>::epsilon();
};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(TensorMassOf, Precisions);

template <class Scalar>
void set_displacement(TensorMass<Scalar>& model, const Field& u) {
  for (int n = 0; n < model.nodes(); ++n) model.set_motion(n, u[n], Vector3d::Zero());
}

template <class Scalar>
Field displacement_of(const TensorMass<Scalar>& model) {
  Field u;
  for (int n = 0; n < model.nodes(); ++n) u.push_back(model.displacement(n));
  return u;
}

/// The force that moves the nodes, from the velocities that one step from rest leaves: none on fixed nodes.
template <class Scalar>
Field force_in_step(const ElasticMesh& mesh, const Field& u) {
  TensorMass<Scalar> model(mesh, Integrator::semi_implicit, 0);
  set_displacement(model, u);
  const double h = 0x1p-10;
  model.step(h);
  Field force;
  for (int n = 0; n < model.nodes(); ++n) force.push_back(model.velocity(n) * model.mass(n) / h);
  return force;
}

TYPED_TEST(TensorMassOf, ForceIsMinusStiffnessTimesDisplacement) {
  const DynamicBody body = dynamic_block({4, 3, 5});
  Field u = random_field(body.mesh.rest.size(), 1e-3, 3);
  TensorMass<TypeParam> model(body.mesh, Integrator::rk4, 0);
  set_displacement(model, u);
  u = displacement_of(model);
  Field expected = internal_force(body.problem.mesh, body.problem.materials, u), elastic;
  for (Vector3d& f : expected) f = -f;
  for (int n = 0; n < model.nodes(); ++n) elastic.push_back(model.elastic_force(n));
  EXPECT_LT(testing::relative_difference(elastic, expected), 1e-12);
  for (int n = 0; n < model.nodes(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (body.mesh.fixed[n][axis]) expected[n][axis] = 0;
  EXPECT_LT(testing::relative_difference(force_in_step<TypeParam>(body.mesh, u), expected), this->kRounding);
}

TYPED_TEST(TensorMassOf, TensorsAreThoseOfTheAssembledMatrix) {
  const DynamicBody body = dynamic_block({2, 3, 2});
  const TensorMass<TypeParam> model(body.mesh, Integrator::rk4, 0);
  const auto nodes = static_cast<Eigen::Index>(body.mesh.rest.size());
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3 * nodes, 3 * nodes);
  for (std::size_t t = 0; t < body.mesh.tetrahedra.size(); ++t) {
    const auto& tet = body.mesh.tetrahedra[t];
    const auto gradients =
        tet_gradients({body.mesh.rest[tet[0]], body.mesh.rest[tet[1]], body.mesh.rest[tet[2]], body.mesh.rest[tet[3]]});
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        expected.block<3, 3>(3 * tet[a], 3 * tet[b]) += stiffness_block(gradients, lame(body.mesh.material(0)), a, b);
  }
  const double tolerance = this->kRounding * expected.cwiseAbs().maxCoeff();
  for (int i = 0; i < nodes; ++i)
    for (int j = 0; j < nodes; ++j) {
      const Eigen::Matrix3d tensor = i == j ? model.vertex_tensor(i) : model.edge_tensor(i, j);
      ASSERT_LT((tensor - expected.block<3, 3>(3 * i, 3 * j)).cwiseAbs().maxCoeff(), tolerance) << i << ", " << j;
      if (i == j) continue;
      ASSERT_EQ(tensor, model.edge_tensor(j, i).transpose());
    }
}

TYPED_TEST(TensorMassOf, RestAndTranslationGiveExactlyNoForce) {
  DynamicBody body = dynamic_block({4, 3, 3});
  std::fill(body.mesh.fixed.begin(), body.mesh.fixed.end(), std::array{false, false, false});
  for (const Vector3d& shift : {Vector3d(0, 0, 0), Vector3d(0.3, -1.7, 12.1)})
    for (const Vector3d& f : force_in_step<TypeParam>(body.mesh, Field(body.mesh.rest.size(), shift)))
      ASSERT_EQ(f, Vector3d::Zero());
}

TYPED_TEST(TensorMassOf, EveryIntegratorEqualsTheTextbookStepByStep) {
  const DynamicBody body = dynamic_block({3, 2, 3});
  const int nodes = body.mesh.nodes();
  const Field u = random_field(nodes, 1e-3, 5), v = random_field(nodes, 0.1, 6), load = random_field(nodes, 1e-3, 7);
  testing::DenseCoupling coupling({1, 5, 17, nodes - 1}, 9);
  const std::vector<double> added(coupling.nodes.size(), 2e-4);
  for (bool coupled : {false, true})
    for (Integrator integrator : {Integrator::rk4, Integrator::semi_implicit, Integrator::forward_euler}) {
      TensorMass<TypeParam> model(body.mesh, integrator, 20);
      Textbook textbook(body, integrator, 20);
      model.set_gravity({1, -2, -9.81});
      if (coupled) {
        model.couple(&coupling, coupling.nodes, added, 1e6);
        textbook.couple(coupling, added);
      }
      for (int n = 0; n < nodes; ++n) {
        model.set_load(n, load[n]);
        model.set_motion(n, u[n], v[n]);
        textbook.set(n, model.displacement(n), model.velocity(n),
                     load[n] + textbook.own_mass(n) * Vector3d(1, -2, -9.81));
      }
      const double h = 0.5 / model.frequency_bound();
      for (int i = 0; i < 10; ++i) model.step(h), textbook.step(h);
      Field velocity;
      for (int n = 0; n < nodes; ++n) velocity.push_back(model.velocity(n));
      const double tolerance = 5 * this->kRounding;
      EXPECT_LT(testing::relative_difference(displacement_of(model), textbook.displacement()), tolerance)
          << "integrator " << static_cast<int>(integrator) << (coupled ? " coupled" : "");
      EXPECT_LT(testing::relative_difference(velocity, textbook.velocity()), tolerance)
          << "integrator " << static_cast<int>(integrator) << (coupled ? " coupled" : "");
    }
}

TYPED_TEST(TensorMassOf, FixedAxesStayWhereTheyAre) {
  DynamicBody body = dynamic_block({3, 3, 3});
  const int partly = body.mesh.nodes() - 1;
  body.mesh.fixed[partly] = {false, true, false};
  TensorMass<TypeParam> model(body.mesh, Integrator::rk4, 1);
  model.set_gravity({0, 5, -9.81});
  model.set_motion(partly, {0, 1, 0}, {0, 1, 0});
  for (int i = 0; i < 100; ++i) model.step(1e-3);
  EXPECT_EQ(model.displacement(partly).y(), 0);
  EXPECT_LT(model.displacement(partly).z(), -1e-5);
  for (int n = 0; n < model.nodes(); ++n)
    if (body.mesh.fixed[n][0]) {
      EXPECT_EQ(model.displacement(n), Vector3d::Zero());
    }
}

TYPED_TEST(TensorMassOf, StateGivesTheSameMotionAgain) {
  const DynamicBody body = dynamic_block({3, 2, 2});
  TensorMass<TypeParam> first(body.mesh, Integrator::rk4, 1), second(body.mesh, Integrator::rk4, 1);
  for (auto* model : {&first, &second}) model->set_gravity({0, 0, -9.81});
  for (int i = 0; i < 50; ++i) first.step(1e-3);
  const std::vector<std::uint8_t> kept = testing::saved(first);
  second.restore(kept.data());
  for (auto* model : {&first, &second})
    for (int i = 0; i < 50; ++i) model->step(1e-3);
  EXPECT_EQ(testing::saved(first), testing::saved(second));
  EXPECT_NE(testing::saved(second), kept);
}

TYPED_TEST(TensorMassOf, EnergyIsElasticPlusKinetic) {
  const DynamicBody body = dynamic_block({2, 2, 2});
  TensorMass<TypeParam> model(body.mesh, Integrator::rk4, 0);
  const Field u = random_field(body.mesh.rest.size(), 1e-3, 5), v = random_field(body.mesh.rest.size(), 0.1, 6);
  for (int n = 0; n < model.nodes(); ++n) model.set_motion(n, u[n], v[n]);
  double expected = 0;
  for (int n = 0; n < model.nodes(); ++n)
    expected +=
        0.5 * model.mass(n) * model.velocity(n).squaredNorm() - 0.5 * model.displacement(n).dot(model.elastic_force(n));
  EXPECT_NEAR(model.energy(), expected, 1e-12 * expected);
}

TYPED_TEST(TensorMassOf, StepAndRemovalTakeNoMemory) {
  const DynamicBody body = dynamic_block({4, 4, 4});
  TensorMass<TypeParam> model(body.mesh, Integrator::rk4, 1);
  testing::DenseCoupling coupling({1, 5, 17}, 9);
  const std::vector<double> added(3, 1e-4);
  model.couple(&coupling, coupling.nodes, added, 1e6);
  const std::array removed{3, 77, 5};
  const long before = allocations();
  for (int i = 0; i < 10; ++i) model.step(1e-4);
  model.remove(removed);
  model.set_load(7, {1, 2, 3});
  EXPECT_EQ(allocations(), before);
}

TEST(TensorMass, RefusesBadTetrahedra) {
  ElasticMesh mesh = dynamic_block({2, 2, 2}).mesh;
  std::swap(mesh.tetrahedra[5][0], mesh.tetrahedra[5][1]);
  EXPECT_THROW(TensorMass<float>(mesh, Integrator::rk4, 0), std::runtime_error);
  mesh = dynamic_block({2, 2, 2}).mesh;
  mesh.materials[0].density = 0;
  EXPECT_THROW(TensorMass<float>(mesh, Integrator::rk4, 0), std::runtime_error);
}

}  // namespace
}  // namespace palpate
