// A scene far from the world's origin is the same scene: its forces, and its surfaces to a micrometre.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/mesh/near_origin.hpp"
#include "common/sim/simulator.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/rig/kinds.hpp"
#include "tools/rig/tip_at.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kSteps = 400;
constexpr double kTop = 0.02, kRadius = 0.006, kDeep = 0.003;  // [m]

/// What a probe meets that goes down into a block within 0.2 s and then aside.
struct Course {
  std::vector<Vector3d> force;    ///< [N] per step
  std::vector<Vector3d> surface;  ///< [m] at the end, from where the scene is
};

// On a regular mesh many nodes are as far from one another as what is averaged reaches: rounding tells which count.
Vector3d uneven(const Vector3d& p) {
  return p + Vector3d(2 * p.x() * p.x() + p.y() * p.z(), 3 * p.y() * p.y() + p.x() * p.y(), 0);
}

Course course_of(Scene scene, const Vector3d& at) {
  TetMesh mesh = small_block_mesh(6);
  for (Vector3d& node : mesh.nodes) node = at + uneven(node);
  if (HybridSpec* split = std::get_if<HybridSpec>(&scene.bodies[0]))
    split->hybrid.regions.push_back({{.box = Box{at + Vector3d(-1, -1, -1), at + Vector3d(0.0026, 1, 1)}}});
  scene.tools[0].pivot = at + Vector3d(0, 0, 0.3);
  scene.tools[0].max_force_rate = 1e6;
  std::get<ProbeSpec>(scene.tools[0].end).radius = kRadius;
  scene.contact.friction = 0.2;
  sim::Simulator simulator(scene, {precompute_on(scene.bodies[0], mesh)});
  const auto input = [&](int step) {
    const double down = std::min(1.0, step / 200.0), aside = std::max(0.0, step / 200.0 - 1);
    const double height = kTop + kRadius + 0.001 - down * (kDeep + 0.001);
    return std::array{
        sim::ToolInput{.dofs = tip_at(scene.tools[0], at + Vector3d(0.003 + 0.004 * aside, 0.002, height))}};
  };
  simulator.start(input(0));
  Course course;
  for (int step = 0; step < kSteps; ++step) {
    simulator.step(input(step));
    course.force.push_back(simulator.tool(0).force);
  }
  const sim::SurfaceView shown = simulator.surface(0);
  for (const Eigen::Vector3f& p : shown.position) course.surface.push_back(shown.origin - at + p.cast<double>());
  return course;
}

/// [N], [m] by which two courses differ at most, and the largest force.
struct Apart {
  double force = 0, surface = 0, largest_force = 0;
};
Apart between(const Course& a, const Course& b) {
  Apart apart;
  for (std::size_t i = 0; i < a.force.size(); ++i) {
    apart.force = std::max(apart.force, (a.force[i] - b.force[i]).norm());
    apart.largest_force = std::max(apart.largest_force, a.force[i].norm());
  }
  for (std::size_t n = 0; n < a.surface.size(); ++n)
    apart.surface = std::max(apart.surface, (a.surface[n] - b.surface[n]).norm());
  return apart;
}

void is_the_same_far_away(const Scene& scene) {
  const Course here = course_of(scene, Vector3d::Zero());
  for (const double far : {1e3, 1e5}) {
    const Apart apart = between(here, course_of(scene, {far, far / 2, -far / 4}));
    fmt::print("{:g} km away: forces of {:.3f} N differ by {:.2g} N at most, surfaces by {:.2g} um\n", far / 1000,
               apart.largest_force, apart.force, 1e6 * apart.surface);
    ASSERT_GT(apart.largest_force, 0.01);
    EXPECT_LT(apart.force, 1e-4 * apart.largest_force);
    EXPECT_LT(apart.surface, 2e-6);
  }
}

TEST(FarScene, OfTissueAtRestIsTheSame) {
  is_the_same_far_away(block_scene());
}

TEST(FarScene, OfTissueThatMovesIsTheSame) {
  is_the_same_far_away(moving_block_scene());
}

TEST(FarScene, OfAHybridIsTheSame) {
  is_the_same_far_away(moving_block_scene<HybridSpec>());
}

TEST(NearOrigin, IsWithinEightMetresAndTheWorldsOwnForWhatIsAboutIt) {
  EXPECT_EQ(near_origin(std::vector<Vector3d>{}), Vector3d::Zero());
  EXPECT_EQ(near_origin(std::vector<Vector3d>{{-7, 7.9, 0}, {1, 7.9, -3}}), Vector3d::Zero());
  const std::vector<Vector3d> far{{1e5, -3e7, 12.1}, {1e5 + 1, -3e7, 12.1}};
  EXPECT_LE((near_origin(far) - far[0]).cwiseAbs().maxCoeff(), 8.5);
  EXPECT_EQ(near_origin(far), Vector3d(near_origin(far).cast<float>().cast<double>())) << "a number of few digits";
}

}  // namespace
}  // namespace palpate
