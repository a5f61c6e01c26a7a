#include "common/fem/factorisation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numeric>

#include "common/fem/condensation.hpp"
#include "common/fem/dense.hpp"
#include "common/fem/ordering.hpp"
#include "common/geometry/dense_solvers.hpp"
#include "common/mesh/surface.hpp"
#include "tests/fem/meshes_for_tests.hpp"

namespace palpate {
namespace {

struct Problem {
  TetMesh mesh = testing::make_organ({4, 3, 3});
  DofMap dofs = apply_boundary_conditions(mesh, testing::make_body().fixed, "body");
  MaterialField materials{{{1000, 0.3, 1000}}, {}};
  SparseMatrix stiffness = assemble_stiffness(mesh, materials, dofs);
  Eigen::MatrixXd dense = Eigen::MatrixXd(stiffness).selfadjointView<Eigen::Lower>();
};

TEST(Factorisation, SolvesBlocksOfRightHandSides) {
  const Problem p;
  Factorisation factor(p.stiffness);
  factor.factorise(p.stiffness);
  for (int columns : {1, 7, 64}) {
    const Eigen::MatrixXd b = Eigen::MatrixXd::Random(p.dofs.size(), columns);
    EXPECT_LT((p.dense * factor.solve(b) - b).norm(), 1e-12 * b.norm());
  }
}

TEST(Factorisation, TrailingFactorIsThatOfTheDenseMatrixInTheGivenOrder) {
  const Problem p;
  std::vector<std::int64_t> order(p.dofs.size());
  std::iota(order.rbegin(), order.rend(), 0);
  Factorisation factor(p.stiffness, order);
  factor.factorise(p.stiffness);
  const Eigen::MatrixXd expected = Eigen::MatrixXd(p.dense.reverse()).llt().matrixL();
  for (int count : {1, 20, p.dofs.size()})
    EXPECT_LT((factor.trailing_factor(count) - expected.bottomRightCorner(count, count)).norm(),
              1e-12 * expected.norm());
}

TEST(Factorisation, RefusesAnIndefiniteMatrix) {
  Problem p;
  p.stiffness.coeffRef(5, 5) = -1;
  Factorisation factor(p.stiffness);
  EXPECT_THROW(factor.factorise(p.stiffness), std::runtime_error);
}

TEST(Factorisation, OrderKeepsTheSurfaceLastAndNamesEveryUsedNodeOnce) {
  const Problem p;
  const auto surface = extract_surface(p.mesh).nodes;
  auto order = interior_first_order(node_graph(p.mesh), surface);
  ASSERT_EQ(order.size(), p.mesh.nodes.size());
  EXPECT_TRUE(std::equal(surface.begin(), surface.end(), order.end() - static_cast<long>(surface.size())));
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], static_cast<int>(i));
}

/// Both routes against the dense inverse, for several shares of touchable nodes.
void expect_compliance(const Problem& p, int keep_every, Route route) {
  std::vector<int> touchable, other;
  for (int node : extract_surface(p.mesh).nodes) (node % keep_every == 0 ? touchable : other).push_back(node);
  const auto result = surface_compliance(p.mesh, p.materials, p.dofs, touchable, other, {}, route);
  EXPECT_EQ(result.condensed, route != Route::solve);
  const Eigen::MatrixXd inverse = invert_general(p.dense);
  const auto list = [&](const std::vector<int>& nodes) {
    std::vector<int> dofs;
    for (int node : nodes)
      for (int axis = 0; axis < 3; ++axis)
        if (p.dofs.is_free(node, axis)) dofs.push_back(p.dofs.index(node, axis));
    return dofs;
  };
  const auto t = list(touchable), o = list(other);
  ASSERT_EQ(result.touchable.size(), t.size() * (t.size() + 1) / 2);
  ASSERT_EQ(result.other.size(), o.size() * t.size());
  double worst = 0;
  for (std::size_t i = 0; i < t.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      worst = std::max(worst, std::abs(result.touchable[i * (i + 1) / 2 + j] - inverse(t[i], t[j])));
  for (std::size_t i = 0; i < o.size(); ++i)
    for (std::size_t j = 0; j < t.size(); ++j)
      worst = std::max(worst, std::abs(result.other[i * t.size() + j] - inverse(o[i], t[j])));
  EXPECT_LT(worst, 1e-11 * inverse.cwiseAbs().maxCoeff());
}

TEST(Condensation, EqualsTheDenseInverse) {
  const Problem p;
  for (int keep_every : {1, 2, 5}) expect_compliance(p, keep_every, Route::condense);
}

TEST(Condensation, EqualsTheDenseInverseByRightHandSides) {
  const Problem p;
  for (int keep_every : {1, 2, 5}) expect_compliance(p, keep_every, Route::solve);
}

TEST(Condensation, WorksWithoutInteriorNodes) {
  Problem p;
  p.mesh = make_block({0, 0, 0}, {1, 1, 0.1}, {6, 6, 1});
  p.dofs = apply_boundary_conditions(p.mesh, {testing::fix_group("x0")}, "body");
  p.stiffness = assemble_stiffness(p.mesh, p.materials, p.dofs);
  p.dense = Eigen::MatrixXd(p.stiffness).selfadjointView<Eigen::Lower>();
  expect_compliance(p, 1, Route::condense);
  expect_compliance(p, 3, Route::condense);
}

TEST(Condensation, SolvesWhereFewNodesAreTouchable) {
  Problem p;
  p.mesh = testing::make_organ({12, 12, 10});
  p.dofs = apply_boundary_conditions(p.mesh, testing::make_body().fixed, "body");
  const auto surface = extract_surface(p.mesh).nodes;
  const std::vector<int> one{surface.back()}, rest(surface.begin(), surface.end() - 1);
  EXPECT_FALSE(surface_compliance(p.mesh, p.materials, p.dofs, one, rest).condensed);
  EXPECT_TRUE(surface_compliance(p.mesh, p.materials, p.dofs, surface, {}).condensed);
}

TEST(Dense, PacksTheLowerTriangleByRows) {
  const Eigen::MatrixXd m = Eigen::MatrixXd::Random(70, 70);
  std::vector<double> packed(70 * 71 / 2);
  pack_lower_by_rows(m, packed.data());
  for (int i = 0; i < 70; ++i)
    for (int j = 0; j <= i; ++j) EXPECT_EQ(packed[i * (i + 1) / 2 + j], m(i, j));
}

}  // namespace
}  // namespace palpate
