// Two probes on both sides of a plate that moves: each presses by a patch of its own, through the tissue against the
// other one's.
#include <fmt/ostream.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/scene/ensure_archive.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/drive/lock_step.hpp"

namespace palpate {
namespace {

constexpr double kTop = 0.01, kRadius = 0.004, kPivot = 0.12;  // [m] of plate and probes, from z = 0

void write_probe(std::ostream& scene, const testing::OwnFolder& folder, const std::string& name, double side,
                 double to_face, double deep) {
  const double above = to_face - kRadius;
  std::ofstream rows(folder / (name + ".csv"));
  fmt::print(rows, "time,yaw,pitch,depth,roll,grip\n0,0,0,{},0,0\n0.5,0,0,{},0,0\n60,0,0,{},0,0\n", above - 0.008,
             above + deep, above + deep);
  fmt::print(scene,
             "[[tool]]\nname = \"{}\"\npivot = [0, 0.0025, {}]\naxis = [0, 0, {}]\nup = [0, 1, 0]\nradius = {}\n"
             "device = \"scripted\"\ntrajectory = \"{}.csv\"\n",
             name, side * kPivot, -side, kRadius, name);
}

Scene pinched(const testing::OwnFolder& folder, double deep) {
  std::ofstream scene(folder / "pinched.toml");
  fmt::print(scene,
             "[[body]]\nname = \"plate\"\nmesh = \"{}\"\nmodel = \"tensor_mass\"\nyoung = 3e4\npoisson = 0.3\n"
             "density = 1000\n[[body.fixed]]\ngroup = \"corners\"\n[body.dynamic]\ndamping = 5\n"
             "[contact]\nfriction = 0.1\n",
             PALPATE_SOURCE "/scenes/meshes/plate_cut.msh");
  write_probe(scene, folder, "above", 1, kPivot - kTop, deep);
  write_probe(scene, folder, "below", -1, kPivot, deep);
  scene.close();
  return load_scene(folder / "pinched.toml");
}

// Quadratic elements of 1.2 mm give 0.1215 N on tissue without inertia, a half-space 0.0879 N (Hertz).
TEST(PinchedPlate, IsFeltAlikeAndWithoutABuzz) {
  const testing::OwnFolder folder("pinched-plate");
  const Scene scene = pinched(folder, 0.001);
  drive::LockStep run(scene, load_or_precompute(scene, ArchivePart::surface));
  const auto force = [&](int tool) { return run.simulator().tool(tool).force; };
  double change = 0;
  while (run.time() < 3) {
    const Eigen::Vector3d before = force(0);
    run.step();
    if (run.time() > 1.5) change = std::max(change, (force(0) - before).norm());
  }
  EXPECT_LT(change, 1e-4);
  EXPECT_GT(force(0).z(), 0.0879);
  EXPECT_LT(force(0).z(), 1.5 * 0.1215);
  EXPECT_NEAR(force(1).z(), -force(0).z(), 0.01 * force(0).z());
}

}  // namespace
}  // namespace palpate
