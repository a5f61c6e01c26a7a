#include <gtest/gtest.h>

#include "common/fem/direct.hpp"
#include "tests/fem/meshes_for_tests.hpp"

/// What one held node of linear tetrahedra can and cannot say.
namespace palpate {
namespace {

/// Force per indentation of the middle node of the top of a slab 1 x 1 x 0.5 on a fixed base, over E h.
/// With `jitter` the inner nodes are moved by up to that share of h.
double node_stiffness(int cells, double poisson, double jitter = 0) {
  const auto mesh = testing::make_jittered_block({1, 1, 0.5}, {cells, cells, cells / 2}, jitter);
  const auto problem = make_static_problem(testing::make_body(1, poisson), mesh);
  const int n = cells + 1, middle = (cells / 2 * n + cells / 2) * n + cells / 2;
  const auto solution = solve_direct(problem, {hold(middle, 0, 0), hold(middle, 1, 0), hold(middle, 2, -1e-3)});
  return -solution.force[middle].z() / 1e-3 * cells;
}

TEST(Locking, StiffnessOfOneNodeHalvesWithEachRefinement) {
  const double coarse = node_stiffness(6, 0.3), fine = node_stiffness(12, 0.3);
  EXPECT_NEAR(fine / coarse, 1, 0.1);  // divided by E h already
}

/// The true change from nu = 0.3 to 0.4999 is of order one. The mirrored pattern of make_block follows it;
/// the same block with its nodes moved does not.
TEST(Locking, IrregularTetrahedraStiffenManyTimesNearIncompressibilityAndMirroredOnesDoNot) {
  EXPECT_LT(node_stiffness(8, 0.4999), 2 * node_stiffness(8, 0.3));
  EXPECT_GT(node_stiffness(8, 0.4999, 0.3), 10 * node_stiffness(8, 0.3, 0.3));
}

}  // namespace
}  // namespace palpate
