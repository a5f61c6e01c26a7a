#include "tools/organ/better_angles.hpp"

#include <gtest/gtest.h>

#include <random>

#include "common/mesh/generators.hpp"
#include "common/mesh/measures.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

constexpr double kSide = 0.1, kEdge = 0.02;

/// A cube of two parts, left and right, whose nodes are off their places: on the surface along it, inside anywhere.
FilledSolid spoilt_cube() {
  FilledSolid filled{make_block({0, 0, 0}, {kSide, kSide, kSide}, {5, 5, 5}), {}};
  for (const auto& t : filled.mesh.tetrahedra) {
    double x = 0;
    for (const int n : t) x += filled.mesh.nodes[n].x() / 4;
    filled.part.push_back(x < 0.4 * kSide ? 1 : 2);
  }
  std::mt19937 random(3);
  std::uniform_real_distribution<double> off(-0.25 * kEdge, 0.25 * kEdge);
  for (auto& x : filled.mesh.nodes)
    for (int i = 0; i < 3; ++i)
      if (const double by = off(random); x[i] > 1e-9 && x[i] < kSide - 1e-9) x[i] += by;
  return filled;
}

bool on_side(double x) {
  return std::abs(x) < 1e-12 || std::abs(x - kSide) < 1e-12;
}

TEST(BetterAngles, WorstAnglesGrowAndTheShapeStays) {
  FilledSolid filled = spoilt_cube();
  const FilledSolid before = filled;
  const double worst = measures_of(before.mesh).min_angle;
  ASSERT_LT(worst, 9);
  better_angles(14, filled);
  EXPECT_GT(measures_of(filled.mesh).min_angle, worst + 3);
  check_tet_mesh(filled.mesh, "cube");
  EXPECT_NEAR(measures_of(filled.mesh).volume, std::pow(kSide, 3), 1e-12);
  std::vector<std::array<bool, 3>> parts(filled.mesh.nodes.size(), {false, false, false});
  for (std::size_t t = 0; t < filled.part.size(); ++t)
    for (const int n : filled.mesh.tetrahedra[t]) parts[n][filled.part[t]] = true;
  int moved = 0;
  for (std::size_t n = 0; n < filled.mesh.nodes.size(); ++n) {
    const Eigen::Vector3d &was = before.mesh.nodes[n], &is = filled.mesh.nodes[n];
    for (int i = 0; i < 3; ++i) EXPECT_EQ(on_side(was[i]), on_side(is[i])) << "node " << n << " left a side";
    const bool between = parts[n][1] && parts[n][2];
    EXPECT_TRUE(!between || was == is) << "node " << n << " lies between parts";
    EXPECT_LE((is - was).norm(), 0.3 * kEdge);
    moved += was != is;
  }
  EXPECT_GT(moved, 0);
}

TEST(BetterAngles, AGoodMeshStaysAsItIs) {
  FilledSolid filled{make_block({0, 0, 0}, {kSide, kSide, kSide}, {4, 4, 4}), {}};
  filled.part.assign(filled.mesh.tetrahedra.size(), 1);
  const auto before = filled.mesh.nodes;
  better_angles(14, filled);
  EXPECT_EQ(filled.mesh.nodes, before);
}

}  // namespace
}  // namespace palpate
