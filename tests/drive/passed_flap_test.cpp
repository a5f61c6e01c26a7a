// A tool that goes past the end of a flap, or through it, lets go of it.
#include <fmt/ostream.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/scene/ensure_archive.hpp"
#include "common/scene/scene_changes.hpp"
#include "common/tool/safety.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/drive/lock_step.hpp"

namespace palpate {
namespace {

/// [s, rad, rad, m, 1]: a person takes the scalpel out of the cut that it makes in scenes/plate_cut.toml, presses it
/// through what has been cut, and goes 4 cm away.
constexpr struct {
  double time, yaw, pitch, depth, pedal;
} kRows[] = {
    {0.00, 0.3805, 0.0000, 0.0969, 0},  {0.50, 0.3640, 0.0000, 0.1019, 0},  {1.00, 0.3298, 0.0000, 0.1120, 0},
    {1.25, 0.3130, 0.0000, 0.1167, 0},  {1.50, 0.2955, 0.0000, 0.1226, 0},  {1.75, 0.2761, 0.0000, 0.1283, 0},
    {2.00, 0.2549, 0.0000, 0.1308, 1},  {2.50, 0.2045, 0.0000, 0.1300, 1},  {3.00, 0.1535, 0.0000, 0.1294, 1},
    {3.12, 0.1412, 0.0000, 0.1294, 1},  {3.14, 0.1349, 0.0026, 0.1286, 0},  {3.20, 0.0915, 0.0186, 0.1229, 0},
    {3.25, 0.0520, 0.0341, 0.1179, 0},  {3.30, 0.0122, 0.0574, 0.1132, 0},  {3.35, -0.0244, 0.0731, 0.1080, 0},
    {3.40, -0.0316, 0.0756, 0.1069, 0}, {3.42, -0.0308, 0.0776, 0.1100, 0}, {3.45, -0.0308, 0.0824, 0.1166, 0},
    {3.50, -0.0294, 0.0856, 0.1232, 0}, {4.00, -0.0326, 0.0885, 0.1230, 0}, {4.05, -0.0317, 0.0860, 0.1190, 0},
    {4.10, -0.0326, 0.0825, 0.1080, 0}, {4.20, -0.0317, 0.0806, 0.1071, 0}, {6.35, -0.0311, 0.0802, 0.1072, 0},
    {6.40, -0.0471, 0.0903, 0.1075, 0}, {6.50, -0.1718, 0.1697, 0.1103, 0}, {6.60, -0.2961, 0.2503, 0.1121, 0},
    {6.65, -0.3417, 0.2881, 0.1131, 0}, {6.70, -0.2504, 0.2885, 0.1135, 0}, {6.75, -0.2351, 0.2884, 0.1136, 0},
    {8.50, -0.2351, 0.2884, 0.1136, 0},
};

Scene scene_in(const testing::OwnFolder& folder) {
  const std::string file = folder / "passed.csv";
  std::ofstream rows(file);
  rows << "time,yaw,pitch,depth,roll,grip,pedal\n";
  for (const auto& r : kRows) fmt::print(rows, "{},{},{},{},0,0,{}\n", r.time, r.yaw, r.pitch, r.depth, r.pedal);
  const std::vector<std::string> changes{"tool.trajectory=" + file};
  return load_scene(PALPATE_SOURCE "/scenes/plate_cut.toml", parse_changes(changes));
}

TEST(PassedFlap, IsLetGoOf) {
  const testing::OwnFolder folder("passed-flap");
  const Scene scene = scene_in(folder);
  drive::LockStep run(scene, load_or_precompute(scene, ArchivePart::surface));
  double largest = 0;
  int implausible = 0;  // steps in which the tissue holds on to it from farther than the haptic node believes
  while (run.time() < 8) {
    run.step();
    const sim::ToolView tool = run.simulator().tool(0);
    largest = std::max(largest, tool.force.norm());
    implausible += (tool.flags & implausible_force) != 0;
  }
  EXPECT_LT(implausible, 20);
  EXPECT_GT(largest, 0.3) << "it was pressed through";
  EXPECT_TRUE(run.simulator().contacts(0).contacts.empty()) << "4 cm away";
}

}  // namespace
}  // namespace palpate
