#include <gtest/gtest.h>

#include <random>

#include "common/dynamics/tensor_mass.hpp"
#include "common/mesh/cut_mesh.hpp"
#include "tests/dynamics/dynamic_meshes.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// Organs, blocks and a cylinder of several sizes and materials.
std::vector<testing::DynamicBody> bodies() {
  const auto bottom = std::vector{testing::fix_group("bottom")};
  std::vector<testing::DynamicBody> made;
  made.push_back(testing::make_dynamic(testing::make_organ({7, 6, 5}), {2e3, 0.45, 1000}, bottom));
  made.push_back(testing::make_dynamic(make_cylinder(0.02, 0.06, 3, 6), {1e6, 0.3, 1100}, bottom));
  made.push_back(testing::dynamic_block({5, 5, 5}, {500, 0.49, 900}));
  made.push_back(
      testing::make_dynamic(make_block_of_five({0, 0, 0}, {0.08, 0.06, 0.05}, {8, 6, 5}), {5e3, 0.1, 1000}, bottom));
  auto& layered = made.back().mesh;  // of two materials
  layered.materials.push_back({4e4, 0.4, 1500});
  for (std::size_t t = 0; t < layered.tetrahedra.size(); ++t) layered.material_of.push_back(t % 3 == 0);
  return made;
}

/// The remaining tetrahedra alone, all nodes kept.
ElasticMesh remaining(const ElasticMesh& mesh, const CutMesh& cut) {
  ElasticMesh rest{mesh.rest, {}, mesh.fixed, mesh.materials, {}};
  for (int t = 0; t < cut.size(); ++t) {
    if (!cut.alive(t)) continue;
    rest.tetrahedra.push_back(mesh.tetrahedra[t]);
    if (!mesh.material_of.empty()) rest.material_of.push_back(mesh.material_of[t]);
  }
  return rest;
}

template <class Scalar>
void expect_same_tensors(const TensorMass<Scalar>& cut, const TensorMass<Scalar>& fresh,
                         std::span<const std::array<int, 2>> edges) {
  for (const auto& [i, j] : edges) ASSERT_EQ(cut.edge_tensor(i, j), fresh.edge_tensor(i, j)) << i << ", " << j;
  for (int n = 0; n < cut.nodes(); ++n) {
    ASSERT_EQ(cut.mass(n), fresh.mass(n));
    ASSERT_EQ(cut.vertex_tensor(n), fresh.vertex_tensor(n));
  }
}

TEST(TensorRemoval, LeavesTheTensorsOfTheRestToTheLastBit) {
  int removals = 0;
  for (unsigned seed = 1; removals < 10000; ++seed) {
    const std::vector<testing::DynamicBody> all = bodies();
    const testing::DynamicBody& body = all[seed % all.size()];
    std::mt19937 random(seed);
    CutMesh cut(body.mesh.tetrahedra, body.mesh.nodes());
    TensorMass<double> twice(body.mesh, Integrator::rk4, 1);
    TensorMass<float> single(body.mesh, Integrator::rk4, 1);
    const ElementTensors whole(body.mesh);
    std::vector<int> removed;
    for (int round = 1; cut.alive_count() > 0; ++round) {
      removed.clear();
      cut.remove(static_cast<int>(random() % cut.size()), removed);
      twice.remove(removed);
      single.remove(removed);
      removals += static_cast<int>(removed.size());
      if (round % 200 != 0 && cut.alive_count() > 0) continue;
      const ElasticMesh left = remaining(body.mesh, cut);
      expect_same_tensors(twice, TensorMass<double>(left, Integrator::rk4, 1), whole.edges());
      expect_same_tensors(single, TensorMass<float>(left, Integrator::rk4, 1), whole.edges());
      ASSERT_FALSE(HasFatalFailure());
    }
  }
  EXPECT_GE(removals, 10000);
}

TEST(TensorRemoval, LeavesTheForcesOfTheRest) {
  for (const testing::DynamicBody& body : bodies()) {
    std::mt19937 random(5);
    CutMesh cut(body.mesh.tetrahedra, body.mesh.nodes());
    TensorMass<double> model(body.mesh, Integrator::semi_implicit, 0);
    std::vector<int> removed;
    while (cut.alive_count() > cut.size() / 2) cut.remove(static_cast<int>(random() % cut.size()), removed);
    model.remove(removed);
    const ElasticMesh left = remaining(body.mesh, cut);
    auto u = testing::random_field(left.rest.size(), 1e-3, 8);
    for (std::size_t n = 0; n < u.size(); ++n)
      if (left.fixed[n][0]) u[n].setZero();
    std::vector<Vector3d> expected =
        internal_force({left.rest, left.tetrahedra, {}}, {left.materials, left.material_of}, u);
    std::vector<Vector3d> force;
    const double h = 0x1p-10;
    for (int n = 0; n < model.nodes(); ++n) model.set_motion(n, u[n], Vector3d::Zero());
    for (int n = 0; n < model.nodes(); ++n) {
      for (int axis = 0; axis < 3; ++axis) expected[n][axis] *= left.fixed[n][axis] ? 0 : -1;
      if (left.fixed[n][0]) continue;
      EXPECT_LT((model.elastic_force(n) - expected[n]).norm(), 1e-9 * (1e-3 + expected[n].norm()));
    }
    model.step(h);
    for (int n = 0; n < model.nodes(); ++n) force.push_back(model.velocity(n) * model.mass(n) / h);
    EXPECT_LT(testing::relative_difference(force, expected), 1e-12);
  }
}

TEST(TensorRemoval, ANodeWithoutTetrahedraStandsStill) {
  const testing::DynamicBody body = testing::dynamic_block({3, 3, 3});
  TensorMass<float> model(body.mesh, Integrator::rk4, 0);
  model.set_gravity({0, 0, -9.81});
  const int corner = body.mesh.nodes() - 1;
  for (int i = 0; i < 20; ++i) model.step(1e-3);
  std::vector<int> around;
  for (int t = 0; t < static_cast<int>(body.mesh.tetrahedra.size()); ++t)
    if (std::ranges::count(body.mesh.tetrahedra[t], corner)) around.push_back(t);
  model.remove(around);
  model.set_load(corner, {1, 1, 1});
  const Vector3d there = model.displacement(corner);
  EXPECT_LT(there.z(), 0);
  for (int i = 0; i < 50; ++i) model.step(1e-3);
  EXPECT_EQ(model.displacement(corner), there);
  EXPECT_EQ(model.velocity(corner), Vector3d::Zero());
  EXPECT_EQ(model.elastic_force(corner), Vector3d::Zero());
  EXPECT_EQ(model.mass(corner), 0);
}

TEST(TensorRemoval, APartCutFreeFallsAsABody) {
  const testing::DynamicBody body = testing::dynamic_block({3, 3, 6});
  TensorMass<float> model(body.mesh, Integrator::rk4, 0);
  std::vector<int> slice;
  for (int t = 0; t < static_cast<int>(body.mesh.tetrahedra.size()); ++t) {
    double height = 0;
    for (int n : body.mesh.tetrahedra[t]) height += body.mesh.rest[n].z() / 4;
    if (height > 0.03 && height < 0.04) slice.push_back(t);
  }
  model.remove(slice);
  model.set_gravity({0, 0, -9.81});
  const double h = 0.9 * max_step(Integrator::rk4, model.frequency_bound(), 0), time = 500 * h;
  for (int i = 0; i < 500; ++i) model.step(h);
  const double fall = 0.5 * 9.81 * time * time;
  for (int n = 0; n < model.nodes(); ++n) {
    const bool falls = body.mesh.rest[n].z() > 0.035;
    if (falls) {
      EXPECT_NEAR(model.displacement(n).z(), -fall, 1e-4 * fall);
    } else {
      EXPECT_LT(model.displacement(n).norm(), 0.05);
    }
  }
}

TEST(TensorRemoval, TheBoundStaysAbove) {
  const testing::DynamicBody body = testing::dynamic_block({3, 3, 3});
  TensorMass<double> model(body.mesh, Integrator::rk4, 0);
  CutMesh cut(body.mesh.tetrahedra, body.mesh.nodes());
  std::mt19937 random(2);
  std::vector<int> removed;
  while (cut.alive_count() > 0) {
    EXPECT_GE(model.frequency_bound(),
              TensorMass<double>(remaining(body.mesh, cut), Integrator::rk4, 0).frequency_bound());
    removed.clear();
    for (int i = 0; i < 8; ++i) cut.remove(static_cast<int>(random() % cut.size()), removed);
    model.remove(removed);
  }
}

}  // namespace
}  // namespace palpate
