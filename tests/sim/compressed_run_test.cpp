// A scene runs on compressed tensors as on dense ones.
#include <gtest/gtest.h>

#include "tests/sim/played_scenes.hpp"
#include "tests/tensors/compressed_copy.hpp"

namespace palpate {
namespace {

/// Both are pressed alike; forces and surfaces are compared to a thousandth of the largest.
void expect_alike(const testing::PlayedScene& played) {
  auto archives = played.archives;
  archives[0] = testing::compressed_copy(archives[0]);
  sim::Simulator dense(played.scene, played.archives), compressed(played.scene, archives);
  dense.start(played.inputs(0));
  compressed.start(played.inputs(0));
  double largest = 0, force_off = 0, deepest = 0, surface_off = 0;
  for (int i = 1; i <= 60; ++i) {
    dense.step(played.inputs(5 * i));
    compressed.step(played.inputs(5 * i));
    largest = std::max(largest, dense.tool(0).force.norm());
    force_off = std::max(force_off, (dense.tool(0).force - compressed.tool(0).force).norm());
    const auto u = dense.displacement(0), v = compressed.displacement(0);
    for (std::size_t n = 0; n < u.size(); ++n) {
      deepest = std::max(deepest, u[n].norm());
      surface_off = std::max(surface_off, (u[n] - v[n]).norm());
    }
  }
  EXPECT_GT(largest, 0.1) << played.name;
  EXPECT_LT(force_off, 1e-3 * largest) << played.name;
  EXPECT_GT(deepest, 1e-3) << played.name;
  EXPECT_LT(surface_off, 1e-3 * deepest) << played.name;
}

TEST(CompressedRun, ForcesAndSurfacesAreThoseOfDenseTensors) {
  expect_alike(testing::pressed_block());
}

TEST(CompressedRun, TissueThatRelaxesUnderAPatchRemembersAlike) {
  expect_alike(testing::relaxing_block());
}

}  // namespace
}  // namespace palpate
