// Tools on both sides of a plate that moves, and beside each other: each presses by a patch of its own, through the
// tissue against the others'.
#include <fmt/ostream.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/scene/ensure_archive.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/drive/lock_step.hpp"

namespace palpate {
namespace {

constexpr double kTop = 0.01, kRadius = 0.004, kPivot = 0.12;  // [m] of plate and probes, from z = 0

struct Probe {
  double x, y;   ///< [m]
  double side;   ///< 1: above, -1: below
  double depth;  ///< [m] into the face
};

void write_probe(std::ostream& scene, const testing::OwnFolder& folder, const std::string& name, const Probe& probe) {
  const double above = kPivot - (probe.side > 0 ? kTop : 0) - kRadius;
  std::ofstream rows(folder / (name + ".csv"));
  fmt::print(rows, "time,yaw,pitch,depth,roll,grip\n0,0,0,{},0,0\n0.5,0,0,{},0,0\n60,0,0,{},0,0\n", above - 0.008,
             above + probe.depth, above + probe.depth);
  fmt::print(scene,
             "[[tool]]\nname = \"{}\"\npivot = [{}, {}, {}]\naxis = [0, 0, {}]\nup = [0, 1, 0]\nradius = {}\n"
             "device = \"scripted\"\ntrajectory = \"{}.csv\"\n",
             name, probe.x, probe.y, probe.side * kPivot, -probe.side, kRadius, name);
}

/// A shaft that comes down level over all of the plate, its tip beyond it.
void write_shaft(std::ostream& scene, const testing::OwnFolder& folder, const std::string& name, double y) {
  std::ofstream rows(folder / (name + ".csv"));
  fmt::print(rows,
             "time,yaw,pitch,depth,roll,grip\n0,0,-0.002,1.95,0,0\n0.5,0,0.00075,1.95,0,0\n60,0,0.00075,1.95,0,0\n");
  fmt::print(scene,
             "[[tool]]\nname = \"{}\"\npivot = [-1.8, {}, {}]\naxis = [1, 0, 0]\nup = [0, 0, 1]\nradius = {}\n"
             "shaft_radius = 0.003\nshaft_length = 0.3\ndevice = \"scripted\"\ntrajectory = \"{}.csv\"\n",
             name, y, kTop + 0.002, kRadius, name);
}

std::ofstream begin_plate(const testing::OwnFolder& folder) {
  std::ofstream scene(folder / "plate.toml");
  fmt::print(scene,
             "[[body]]\nname = \"plate\"\nmesh = \"{}\"\nmodel = \"tensor_mass\"\nyoung = 3e4\npoisson = 0.3\n"
             "density = 1000\n[[body.fixed]]\ngroup = \"corners\"\n[body.dynamic]\ndamping = 5\n"
             "[contact]\nfriction = 0.1\n",
             PALPATE_SOURCE "/scenes/meshes/plate_cut.msh");
  return scene;
}

Scene under_probes(const testing::OwnFolder& folder, const std::vector<Probe>& probes) {
  std::ofstream scene = begin_plate(folder);
  for (std::size_t i = 0; i < probes.size(); ++i) write_probe(scene, folder, fmt::format("probe{}", i), probes[i]);
  scene.close();
  return load_scene(folder / "plate.toml");
}

Scene under_shafts(const testing::OwnFolder& folder) {
  std::ofstream scene = begin_plate(folder);
  write_shaft(scene, folder, "left", 0);
  write_shaft(scene, folder, "right", 0.009);
  scene.close();
  return load_scene(folder / "plate.toml");
}

/// [N] By which any tool's force changes from tick to tick, at most, once the scene has stood for half a second or
/// more.
double change_when_held(drive::LockStep& run, double until) {
  const int tools = static_cast<int>(run.simulator().scene().tools.size());
  std::vector<Eigen::Vector3d> before(tools, Eigen::Vector3d::Zero());
  double change = 0;
  while (run.time() < until) {
    run.step();
    for (int i = 0; i < tools; ++i) {
      const Eigen::Vector3d force = run.simulator().tool(i).force;
      if (run.time() > until - 0.5) change = std::max(change, (force - before[i]).norm());
      before[i] = force;
    }
  }
  return change;
}

/// [N] Of all tools; tissue that has been thrown away is not felt.
double least_force(const drive::LockStep& run) {
  const auto& simulator = run.simulator();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < simulator.scene().tools.size(); ++i)
    least = std::min(least, simulator.tool(static_cast<int>(i)).force.norm());
  return least;
}

// Quadratic elements of 1.2 mm give 0.1215 N on tissue without inertia, a half-space 0.0879 N (Hertz).
TEST(PinchedPlate, IsFeltAlikeAndWithoutABuzz) {
  const testing::OwnFolder folder("pinched-plate");
  const Scene scene = under_probes(folder, {{0, 0.0025, 1, 0.001}, {0, 0.0025, -1, 0.001}});
  drive::LockStep run(scene, load_or_precompute(scene, ArchivePart::surface));
  EXPECT_LT(change_when_held(run, 3), 1e-4);
  const auto force = [&](int tool) { return run.simulator().tool(tool).force.z(); };
  EXPECT_GT(force(0), 0.0879);
  EXPECT_LT(force(0), 1.5 * 0.1215);
  EXPECT_NEAR(force(1), -force(0), 0.01 * force(0));
}

// Each moves the plate under the other.
TEST(PinchedPlate, ProbesBesideEachOtherStand) {
  const testing::OwnFolder folder("probes-on-plate");
  for (const double aside : {0.0085, 0.011}) {
    const Scene scene = under_probes(folder, {{0, 0.0025, 1, 0.004}, {aside, 0.0025, 1, 0.004}});
    drive::LockStep run(scene, load_or_precompute(scene, ArchivePart::surface));
    EXPECT_LT(change_when_held(run, 2.5), 5e-4) << aside;
    EXPECT_GT(least_force(run), 0.02) << aside;
  }
}

TEST(PinchedPlate, OneBesideTwoThatPinchItStands) {
  const testing::OwnFolder folder("three-on-plate");
  const Scene scene = under_probes(folder, {{0, 0.0025, 1, 0.002}, {0.0085, 0.0025, 1, 0.002}, {0, 0.0025, -1, 0.002}});
  drive::LockStep run(scene, load_or_precompute(scene, ArchivePart::surface));
  EXPECT_LT(change_when_held(run, 2.5), 5e-4);
  EXPECT_GT(least_force(run), 0.1);
}

TEST(PinchedPlate, ShaftsBesideEachOtherStand) {
  const testing::OwnFolder folder("shafts-on-plate");
  const Scene scene = under_shafts(folder);
  drive::LockStep run(scene, load_or_precompute(scene, ArchivePart::surface));
  EXPECT_LT(change_when_held(run, 1.5), 1e-3);
  EXPECT_GT(least_force(run), 0.005);
}

}  // namespace
}  // namespace palpate
