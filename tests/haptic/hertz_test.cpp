#include <gtest/gtest.h>

#include <cmath>

#include "common/mesh/generators.hpp"
#include "common/tensors/precompute.hpp"
#include "haptic_node/haptic_step.hpp"
#include "tests/haptic/block_scene.hpp"

namespace palpate {
namespace {

constexpr double tip_radius = 0.01, young = 5000, poisson = 0.3;

/// Grid coordinates from 0 outwards: steps of h to `fine`, then growing by 1.35 to exactly `end`.
std::vector<double> graded(double h, double fine, double end) {
  std::vector<double> x{0};
  while (x.back() < fine - 1e-12) x.push_back(x.back() + h);
  const std::size_t first = x.size();
  for (double step = h; x.back() < end;) x.push_back(x.back() + (step *= 1.35));
  const double stretch = (end - x[first - 1]) / (x.back() - x[first - 1]), from = x[first - 1];
  for (std::size_t i = first; i < x.size(); ++i) x[i] = from + stretch * (x[i] - from);
  return x;
}

/// Force [N] on a frictionless tip pressed `depth` into the middle of a block of half-width and height 8 R with
/// elements of size h under the tip.
double press(double h, double depth, const Eigen::Vector3d& at) {
  const std::vector<double> half = graded(h, 1.25 * tip_radius, 8 * tip_radius);
  std::vector<double> across, down;
  for (auto x = half.rbegin(); x != half.rend(); ++x) across.push_back(-*x);
  across.insert(across.end(), half.begin() + 1, half.end());
  for (auto x = half.rbegin(); x != half.rend(); ++x) down.push_back(-*x);
  const TetMesh mesh = make_graded_block(across, across, down);

  Scene scene;
  Body body;
  body.name = "block";
  body.material = {.young = young, .poisson = poisson, .density = 1000};
  const double base = -8 * tip_radius;
  body.fixed.push_back({.where = {.box = Box{{-1, -1, base - 1e-6}, {1, 1, base + 1e-6}}}});
  const double reach = 1.2 * tip_radius;
  body.touchable = Selector{.box = Box{{-reach, -reach, -1e-6}, {reach, reach, 1e-6}}};
  scene.bodies.push_back(body);
  Tool tool;
  tool.name = "ball";
  tool.pivot = at + Eigen::Vector3d(0, 0, 0.2);
  tool.radius = tip_radius;
  tool.max_force = 1e3;
  tool.max_force_rate = 1e9;
  scene.tools.push_back(tool);
  scene.contact.friction = 0;

  HapticStep haptic(scene, {precompute(body, mesh)});
  haptic.start(std::array{testing::tip_at(tool, at + Eigen::Vector3d(0, 0, 1.05 * tip_radius))});
  const int steps = 200;
  for (int i = 0; i <= steps + 20; ++i) {
    const double z = tip_radius * 1.05 + (tip_radius - depth - tip_radius * 1.05) * std::min(1.0, double(i) / steps);
    haptic.step(std::array{testing::tip_at(tool, at + Eigen::Vector3d(0, 0, z))});
  }
  return haptic.force(0).z();
}

double hertz(double depth) {
  return 4.0 / 3 * young / (1 - poisson * poisson) * std::sqrt(tip_radius) * std::pow(depth, 1.5);
}

// Indentation R/2, the tip's axis at several places between the nodes. On a single place the number of nodes under
// the tip changes in steps (at R = 2h nine or fewer), which is worth up to 7 %; the mean over the places is what a
// tool feels that is not aligned with the mesh.
TEST(Hertz, ATipsForceOnALargeBlockFollowsHertzWithinTenPercentAndDoesNotDependOnTheMesh) {
  const double depth = 0.5 * tip_radius, h = tip_radius / 2;
  double mean_coarse = 0, mean_fine = 0;
  const std::vector<Eigen::Vector3d> places{{0, 0, 0}, {0.25 * h, 0.1 * h, 0}, {0.5 * h, 0.25 * h, 0}, {0.5 * h, 0.5 * h, 0}};
  for (const Eigen::Vector3d& at : places) {
    const double coarse = press(tip_radius / 2, depth, at), fine = press(tip_radius / 4, depth, at);
    EXPECT_NEAR(coarse, hertz(depth), 0.1 * hertz(depth)) << "R = 2h, at " << at.transpose();
    EXPECT_NEAR(fine, hertz(depth), 0.1 * hertz(depth)) << "R = 4h, at " << at.transpose();
    std::printf("at (%.1f, %.1f) mm: F/Hertz %.3f (R = 2h), %.3f (R = 4h)\n", 1e3 * at.x(), 1e3 * at.y(), coarse / hertz(depth),
                fine / hertz(depth));
    mean_coarse += coarse / places.size();
    mean_fine += fine / places.size();
  }
  std::printf("halving h changes the mean force by %.1f %%\n", 100 * (mean_fine / mean_coarse - 1));
  EXPECT_NEAR(mean_fine, mean_coarse, 0.05 * mean_coarse);
}

}  // namespace
}  // namespace palpate
