#include <gtest/gtest.h>

#include <cmath>

#include "common/archive/static_solve.hpp"
#include "common/fem/direct.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "tests/fem/meshes_for_tests.hpp"
#include "tests/tensors/spread_holds.hpp"

/// The static state through the archive equals the direct solve.
namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::relative_difference;
using testing::spread_holds;

constexpr double kTolerance = 1e-8;

/// Displacements over the whole surface; forces where the archive knows them, on free axes.
void expect_agreement(const Archive& archive, const StaticSolution& direct, const SurfaceSolution& tensors) {
  std::vector<Vector3d> displacement, force;
  for (int i = 0; i < archive.surface.size(); ++i) {
    displacement.push_back(direct.displacement[archive.surface.node_number[i]]);
    force.push_back(direct.force[archive.surface.node_number[i]]);
    for (int axis = 0; axis < 3; ++axis)
      if (archive.surface.fixed[i][axis]) force.back()[axis] = 0;
  }
  EXPECT_LT(relative_difference(tensors.displacement, displacement), kTolerance);
  EXPECT_LT(relative_difference(tensors.force, force), kTolerance);
}

void expect_agreement(const QuasiStaticSpec& body, const TetMesh& mesh, const std::vector<int>& counts) {
  const auto problem = make_static_problem(body, mesh);
  const auto archive = precompute(body, mesh);
  for (int count : counts) {
    const auto holds = spread_holds(archive, count);
    SCOPED_TRACE(::testing::Message() << count << " nodes, nu " << body.material.poisson << ", E "
                                      << body.material.young);
    expect_agreement(archive, solve_direct(problem, holds), solve_tensors(archive, holds));
  }
}

TEST(Agreement, HoldsForEveryNumberOfNodesAndPoissonRatio) {
  for (double poisson : {0.0, 0.3, 0.45, 0.499})
    expect_agreement(testing::make_body(10e3, poisson), testing::make_organ({10, 8, 6}), {1, 3, 12, 64});
}

TEST(Agreement, HoldsForABlock) {
  for (double poisson : {0.0, 0.3, 0.45, 0.499})
    expect_agreement(testing::make_body(10e3, poisson), make_block({0, 0, 0}, {0.1, 0.1, 0.1}, {8, 8, 8}),
                     {1, 3, 12, 64});
}

TEST(Agreement, HoldsFromOnePascalToOneTerapascal) {
  for (double young : {1.0, 1e12})
    for (double poisson : {0.0, 0.499})
      expect_agreement(testing::make_body(young, poisson), testing::make_organ({8, 6, 5}), {1, 12, 64});
}

TEST(Agreement, HoldsForNodesSideBySide) {
  const auto mesh = testing::make_organ({8, 6, 5});
  const auto body = testing::make_body(10e3, 0.499);
  const auto archive = precompute(body, mesh);
  std::vector<Constraint> holds;
  const auto& numbers = archive.surface.node_number;
  for (int k = archive.surface.touchable - 40; k < archive.surface.touchable; ++k)
    for (int axis = 0; axis < 3; ++axis) holds.push_back(hold(numbers[k], axis, 1e-3 * (axis - 1)));
  expect_agreement(archive, solve_direct(make_static_problem(body, mesh), holds), solve_tensors(archive, holds));
}

TEST(Agreement, HoldsForSingleAxes) {
  const auto mesh = testing::make_organ({8, 6, 5});
  const auto body = testing::make_body();
  const auto archive = precompute(body, mesh);
  auto holds = spread_holds(archive, 12);
  for (std::size_t i = 0; i < holds.size(); ++i) holds.erase(holds.begin() + static_cast<long>(i));
  ASSERT_EQ(holds.size(), 18u);
  const auto direct = solve_direct(make_static_problem(body, mesh), holds);
  const auto tensors = solve_tensors(archive, holds);
  expect_agreement(archive, direct, tensors);
}

TEST(Agreement, HoldsForPartlyFixedNodes) {
  auto body = testing::make_body();
  body.fixed = {testing::fix_group("z0", {false, false, true}), testing::fix_group("x0", {true, false, false}),
                testing::fix_group("y1", {false, true, false})};
  expect_agreement(body, testing::make_organ({7, 6, 5}), {1, 3, 12, 64});
}

TEST(Agreement, HoldsForRegionsOfOtherMaterials) {
  auto body = testing::make_body();
  MaterialRegion stiff;
  stiff.where.box = Box{{-1, -1, 0.03}, {0, 1, 1}};
  stiff.material = {500e3, 0.2, 1000};
  body.materials = {stiff};
  expect_agreement(body, testing::make_organ({8, 6, 5}), {1, 3, 12, 64});
}

TEST(Agreement, HoldsForARestrictedTouchableSet) {
  auto body = testing::make_body();
  body.touchable = NodeSelector{};
  body.touchable->group = "top";
  const auto mesh = testing::make_organ({8, 8, 6});
  const auto archive = precompute(body, mesh);
  EXPECT_EQ(archive.surface.touchable, 81);
  EXPECT_GT(archive.other_dofs.size(), 0u);
  expect_agreement(body, mesh, {1, 12, 64});
}

TEST(Agreement, HoldsForPointsInsideTriangles) {
  const auto mesh = testing::make_organ({8, 6, 5});
  const auto body = testing::make_body();
  const auto archive = precompute(body, mesh);
  std::vector<Constraint> constraints;
  const auto& surface = archive.surface;
  for (std::size_t t = 5; t < surface.triangles.size(); t += 40) {
    const auto& corners = surface.triangles[t];
    if (std::any_of(corners.begin(), corners.end(), [&](int k) { return k >= surface.touchable; })) continue;
    for (int axis = 0; axis < 3; ++axis) {
      Constraint one{{}, 1e-3 * std::cos(3.0 * t + axis)};
      for (int c = 0; c < 3; ++c) one.terms.push_back({surface.node_number[corners[c]], axis, (c + 1) / 6.0});
      constraints.push_back(one);
    }
  }
  ASSERT_GT(constraints.size(), 12u);
  expect_agreement(archive, solve_direct(make_static_problem(body, mesh), constraints),
                   solve_tensors(archive, constraints));
}

TEST(Agreement, BothRoutesOfThePrecomputationAgree) {
  const auto mesh = testing::make_organ({8, 6, 5});
  const auto body = testing::make_body();
  const auto a = precompute(body, mesh, nullptr, {}, Route::condense);
  const auto b = precompute(body, mesh, nullptr, {}, Route::solve);
  double worst = 0, size = 0;
  for (std::size_t i = 0; i < a.touchable_compliance.size(); ++i) {
    worst = std::max(worst, std::abs(a.touchable_compliance[i] - b.touchable_compliance[i]));
    size = std::max(size, std::abs(a.touchable_compliance[i]));
  }
  EXPECT_LT(worst, 1e-11 * size);
}

TEST(StaticSolve, RefusesInWords) {
  auto body = testing::make_body();
  body.touchable = NodeSelector{};
  body.touchable->group = "top";
  const auto mesh = testing::make_organ({4, 4, 3});
  const auto archive = precompute(body, mesh);
  const auto refusal = [&](const std::vector<Constraint>& constraints) -> std::string {
    try {
      solve_tensors(archive, constraints);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  const int top = static_cast<int>(mesh.nodes.size()) - 1, side = 25, inside = 25 + 6;
  EXPECT_EQ(refusal({hold(0, 0, 1)}), "node 0 cannot be held along x: it is fixed");
  EXPECT_EQ(refusal({hold(side, 0, 1)}), "node 25 is not touchable");
  EXPECT_EQ(refusal({hold(inside, 0, 1)}), "node 31 is not on the surface");
  EXPECT_NE(refusal({hold(top, 0, 1), hold(top, 0, 1)}), "");
  EXPECT_EQ(refusal({hold(top, 0, 1)}), "");
}

}  // namespace
}  // namespace palpate
