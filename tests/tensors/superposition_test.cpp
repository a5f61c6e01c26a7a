#include <gtest/gtest.h>

#include "common/archive/static_solve.hpp"
#include "common/fem/direct.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "tests/fem/meshes_for_tests.hpp"

/// TVCG99 fig. 10 on a plate held at its corners.
namespace palpate {
namespace {

constexpr int kCells = 16;

int top_node(int i, int j) {
  return (2 * (kCells + 1) + j) * (kCells + 1) + i;
}

struct Plate {
  TetMesh mesh = make_block({0, 0, 0}, {0.2, 0.2, 0.01}, {kCells, kCells, 2});
  QuasiStaticSpec body = testing::make_body(100e3, 0.3);
  Archive archive;

  Plate() {
    std::vector<int> corners;
    for (int k = 0; k <= 2; ++k)
      for (int j : {0, kCells})
        for (int i : {0, kCells}) corners.push_back((k * (kCells + 1) + j) * (kCells + 1) + i);
    body.fixed = {testing::fix_nodes(corners)};
    archive = precompute(body, mesh);
  }

  Eigen::Vector3d at(const SurfaceSolution& solution, int node) const {
    const auto& numbers = archive.surface.node_number;
    return solution.displacement[std::find(numbers.begin(), numbers.end(), node) - numbers.begin()];
  }
};

std::vector<Constraint> press(int node, double depth) {
  return {hold(node, 0, 0), hold(node, 1, 0), hold(node, 2, -depth)};
}

TEST(Superposition, PlainSumOvershootsForTwoNearbyNodesAndEquationEightDoesNot) {
  const Plate plate;
  const int a = top_node(kCells / 2, kCells / 2), b = top_node(kCells / 2 + 1, kCells / 2);
  auto holds = press(a, 0.01);
  for (const auto& one : press(b, 0.01)) holds.push_back(one);
  const auto plain = superpose_tensors(plate.archive, holds, Superposition::plain);
  const auto corrected = superpose_tensors(plate.archive, holds, Superposition::corrected);
  EXPECT_LT(plate.at(plain, a).z(), -0.015);  // more than half as much again as the tool's 10 mm
  for (int node : {a, b}) {
    EXPECT_NEAR(plate.at(corrected, node).z(), -0.01, 1e-12);
    EXPECT_NEAR(plate.at(corrected, node).x(), 0, 1e-12);
  }
}

TEST(Superposition, PlainSumIsExactForOneNode) {
  const Plate plate;
  const auto holds = press(top_node(5, 8), 0.01);
  const auto plain = superpose_tensors(plate.archive, holds, Superposition::plain);
  const auto exact = solve_tensors(plate.archive, holds);
  EXPECT_LT(testing::relative_difference(plain.displacement, exact.displacement), 1e-12);
  EXPECT_LT(testing::relative_difference(plain.force, exact.force), 1e-12);
}

TEST(Superposition, EquationEightEqualsTheDirectSolveForSeveralContacts) {
  const Plate plate;
  std::vector<Constraint> holds;
  for (int i : {3, 4, 8, 12})
    for (int j : {5, 11})
      for (const auto& one : press(top_node(i, j), 0.002 * i)) holds.push_back(one);
  const auto corrected = superpose_tensors(plate.archive, holds, Superposition::corrected);
  const auto direct = solve_direct(make_static_problem(plate.body, plate.mesh), holds);
  std::vector<Eigen::Vector3d> displacement, force;
  for (int i = 0; i < plate.archive.surface.size(); ++i) {
    displacement.push_back(direct.displacement[plate.archive.surface.node_number[i]]);
    force.push_back(plate.archive.surface.fixed[i][0] ? Eigen::Vector3d::Zero()
                                                      : direct.force[plate.archive.surface.node_number[i]]);
  }
  EXPECT_LT(testing::relative_difference(corrected.displacement, displacement), 1e-8);
  EXPECT_LT(testing::relative_difference(corrected.force, force), 1e-8);
}

TEST(Superposition, EquationEightServesSingleAxes) {
  const Plate plate;
  const std::vector<Constraint> holds{hold(top_node(8, 8), 2, -0.01), hold(top_node(9, 8), 2, -0.008),
                                      hold(top_node(9, 8), 0, 0.001)};
  const auto corrected = superpose_tensors(plate.archive, holds, Superposition::corrected);
  const auto exact = solve_tensors(plate.archive, holds);
  EXPECT_LT(testing::relative_difference(corrected.displacement, exact.displacement), 1e-10);
  EXPECT_LT(testing::relative_difference(corrected.force, exact.force), 1e-10);
}

}  // namespace
}  // namespace palpate
