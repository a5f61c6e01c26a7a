#include "common/fem/assembly.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/fem/meshes_for_tests.hpp"

namespace palpate {
namespace {

Eigen::MatrixXd full(const SparseMatrix& lower) {
  return Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
}

MaterialField uniform() {
  return {{{1000, 0.3, 1000}}, {}};
}

TEST(Assembly, EqualsTheSumOfDenseElementMatrices) {
  const auto mesh = testing::make_organ({2, 2, 2});
  const int n = static_cast<int>(3 * mesh.nodes.size());
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(n, n);
  for (const auto& tet : mesh.tetrahedra) {
    const auto k = element_stiffness(
        tet_gradients({mesh.nodes[tet[0]], mesh.nodes[tet[1]], mesh.nodes[tet[2]], mesh.nodes[tet[3]]}),
        lame(uniform().materials[0]));
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) expected.block<3, 3>(3 * tet[i], 3 * tet[j]) += k.block<3, 3>(3 * i, 3 * j);
  }
  const auto actual = full(assemble_stiffness(mesh, uniform(), DofMap(mesh)));
  EXPECT_LT((actual - expected).norm(), 1e-14 * expected.norm());
}

TEST(Assembly, LeavesFixedDofsOut) {
  const auto mesh = testing::make_organ({2, 2, 2});
  const auto dofs = apply_boundary_conditions(mesh, testing::make_body().fixed, "body");
  const auto whole = full(assemble_stiffness(mesh, uniform(), DofMap(mesh)));
  const auto reduced = full(assemble_stiffness(mesh, uniform(), dofs));
  ASSERT_EQ(reduced.rows(), dofs.size());
  for (int i = 0; i < dofs.size(); ++i)
    for (int j = 0; j < dofs.size(); ++j) ASSERT_EQ(reduced(i, j), whole(dofs.dof(i), dofs.dof(j)));
}

TEST(Assembly, InternalForceIsTheStiffnessTimesTheDisplacement) {
  const auto mesh = testing::make_organ({3, 2, 2});
  const Eigen::VectorXd u = Eigen::VectorXd::Random(3 * static_cast<int>(mesh.nodes.size()));
  std::vector<Eigen::Vector3d> field;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) field.push_back(u.segment<3>(3 * static_cast<int>(i)));
  const auto force = internal_force(mesh, uniform(), field);
  const Eigen::VectorXd expected = full(assemble_stiffness(mesh, uniform(), DofMap(mesh))) * u;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    EXPECT_LT((force[i] - expected.segment<3>(3 * static_cast<int>(i))).norm(), 1e-13 * expected.norm());
}

TEST(Assembly, StoresNothingPerElementForOneMaterial) {
  const auto field = material_field(testing::make_body(), testing::make_organ({2, 2, 2}));
  EXPECT_EQ(field.of_element.capacity(), 0u);
  EXPECT_EQ(field.materials.size(), 1u);
}

TEST(Assembly, LaterMaterialRegionsOverrideEarlierOnes) {
  const auto mesh = make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  auto body = testing::make_body();
  MaterialRegion right, some;
  right.where.box = Box{{0.5, 0, 0}, {1, 1, 1}};
  right.material = {5000, 0.2, 1000};
  some.where.indices = {0, 47};
  some.material = {7000, 0.1, 1000};
  body.materials = {right, some};
  const auto field = material_field(body, mesh);
  EXPECT_EQ(field.at(0).young, 7000);
  EXPECT_EQ(field.at(47).young, 7000);
  EXPECT_EQ(field.at(1).young, body.material.young);
  EXPECT_EQ(std::count(field.of_element.begin(), field.of_element.end(), 1), 23);
}

TEST(Assembly, RefusesAMaterialRegionWithoutElements) {
  auto body = testing::make_body();
  MaterialRegion nowhere;
  nowhere.where.box = Box{{5, 5, 5}, {6, 6, 6}};
  body.materials = {nowhere};
  EXPECT_THROW(material_field(body, testing::make_organ({2, 2, 2})), std::runtime_error);
}

}  // namespace
}  // namespace palpate
