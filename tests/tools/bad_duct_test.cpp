#include <gtest/gtest.h>

#include "common/mesh/shell_file.hpp"
#include "common/mesh/shell_generators.hpp"
#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using testing::expect_refusal;
using testing::OwnFolder;
using testing::program;
using testing::replaced;
using testing::run_program;
using testing::text_of;

/// A small duct with a catheter before its mouth and a forceps, which one thing spoils.
class ToolsBadDuct : public ::testing::Test {
 protected:
  ToolsBadDuct() {
    write_shell_mesh(tube_, folder_ / "duct.msh");
    write("motion.csv", "time,yaw,pitch,depth,roll,grip\n0,0,0,0.10,0,0.5\n1,0,0,0.11,0,0.9\n");
    write("scene.toml", R"(title = "a small duct"
[[body]]
name = "duct"
mesh = "duct.msh"
model = "modal_shell"
young = 300000
poisson = 0.45

[[body.fixed]]
group = "end1"

[body.shell]
thickness = 0.001
modes = 12

[[body]]
name = "wire"
model = "catheter"
young = 3e7

[body.catheter]
inside = "duct"
tail = [0, 0, -0.05]
tip = [0, 0, -0.005]
radius = 0.001
particles = 24

[[tool]]
name = "hand"
kind = "forceps"
pivot = [0, -0.15, 0.02]
axis = [0, 1, 0]
up = [0, 0, 1]
device = "scripted"
trajectory = "motion.csv"

[tool.jaws]
length = 0.012
max_open = 1.0

[render]
width = 320
height = 240
)");
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  std::string scene() const { return folder_ / "scene.toml"; }
  void replace(const std::string& from, const std::string& to) {
    write("scene.toml", replaced(text_of(scene()), from, to));
  }
  std::string palpate_on(const char* command) const {
    return fmt::format("{} {} {}", program("palpate"), command, scene());
  }

  /// check, precompute and run refuse the scene with the same sentence.
  void expect_refused(const std::vector<std::string>& fragments) {
    for (const char* command : {"check", "precompute", "run"}) expect_refusal(palpate_on(command), fragments);
  }

  OwnFolder folder_{"bad-duct"};
  ShellMesh tube_ = make_tube(0.005, 0.04, 12, 8);
};

TEST_F(ToolsBadDuct, TheSceneIsGoodBeforeItIsSpoiledAndCheckDescribesIt) {
  const auto before = run_program(palpate_on("check"));
  EXPECT_EQ(before.status, 0) << before.err;
  for (const char* fragment :
       {"model modal_shell", "108 nodes, 192 triangles", "a tube with two open ends", "12 of 288 are kept", "clamped",
        "model catheter", "24 particles", "implicit, 1 step in each haptic one",
        "jaws of 0.012 m that open from 0 to 1 rad", "not computed yet"})
    EXPECT_NE(before.out.find(fragment), std::string::npos) << fragment << "\n" << before.out;
  const auto precomputed = run_program(palpate_on("precompute"));
  EXPECT_EQ(precomputed.status, 0) << precomputed.err;
  const auto after = run_program(palpate_on("check"));
  EXPECT_NE(after.out.find("frequencies: "), std::string::npos) << after.out;
}

TEST_F(ToolsBadDuct, AMeshWithAHoleWhereATubeIsExpectedIsRefused) {
  ShellMesh holed = tube_;
  holed.triangles.erase(holed.triangles.begin() + 90);
  write_shell_mesh(holed, folder_ / "duct.msh");
  expect_refused({"duct.msh: a tube with two open ends is expected", "has 3 boundary lines"});
  replace("inside = \"duct\"\n", "");
  EXPECT_EQ(run_program(palpate_on("check")).status, 0);
}

TEST_F(ToolsBadDuct, AThicknessOfZeroIsRefusedAtItsPlace) {
  replace("thickness = 0.001", "thickness = 0");
  expect_refused({"scene.toml:13:13: thickness must be greater than 0, and is 0"});
}

TEST_F(ToolsBadDuct, AWallThickerThanTheRadiusIsRefused) {
  replace("inside = \"duct\"\n", "");
  replace("thickness = 0.001", "thickness = 0.006");
  expect_refused({"body 'duct': the wall is 6 mm thick, and the radius of its middle surface is 4.83 mm"});
}

TEST_F(ToolsBadDuct, MoreModesThanDofsAreRefused) {
  replace("modes = 12", "modes = 289");
  expect_refused({"body 'duct': it asks for 289 modes, and its mesh has 288 free displacements"});
}

TEST_F(ToolsBadDuct, ACatheterWiderThanTheDuctIsRefusedWithAndWithoutAnArchive) {
  replace("radius = 0.001\n", "radius = 0.0045\n");
  expect_refused({"duct.msh: the catheter 'wire' is 9 mm wide, and the duct 'duct' is 8.659 mm wide inside"});
  replace("radius = 0.0045\n", "radius = 0.001\n");
  ASSERT_EQ(run_program(palpate_on("precompute")).status, 0);
  replace("radius = 0.001\n", "radius = 0.0045\n");
  expect_refused({"duct.msh: the catheter 'wire' is 9 mm wide"});
}

TEST_F(ToolsBadDuct, ACatheterInTheWallIsRefused) {
  replace("tip = [0, 0, -0.005]", "tip = [0, 0.004, 0.005]");
  expect_refusal(palpate_on("check"), {"body 'wire': at rest it sticks in the wall of 'duct'"});
}

TEST_F(ToolsBadDuct, ACatheterTooStiffForSubstepsIsRefused) {
  replace("particles = 24", "particles = 24\nintegrator = \"semi_implicit\"");
  replace("young = 3e7", "young = 3e11");
  expect_refusal(palpate_on("check"), {"body 'wire': the catheter is too stiff for semi_implicit"});
}

TEST_F(ToolsBadDuct, AGripThatTheJawsCannotReachIsRefused) {
  ASSERT_EQ(run_program(palpate_on("precompute")).status, 0);
  write("motion.csv", "time,yaw,pitch,depth,roll,grip\n0,0,0,0.10,0,0.5\n1,0,0,0.11,0,1.2\n");
  const std::vector<std::string> sentence{
      "motion.csv: the grip of 1.2 rad at 1 s is out of range: the jaws of 'hand' open from 0 to 1 rad"};
  expect_refusal(palpate_on("check"), sentence);
  expect_refusal(program("haptic_node") + " " + scene(), sentence);
  write("motion.csv", "time,yaw,pitch,depth,roll,grip\n0,0,0,0.10,0,-0.1\n");
  expect_refusal(palpate_on("check"), {"motion.csv: the grip of -0.1 rad at 0 s is out of range"});
  replace("max_open = 1.0", "max_open = 2.7");
  expect_refusal(palpate_on("check"), {"scene.toml:", "max_open must be greater than 0 and at most 2.5, and is 2.7"});
}

TEST_F(ToolsBadDuct, AToolThatStartsOnTheWallOrTheCatheterIsRefused) {
  write("motion.csv", "time,yaw,pitch,depth,roll,grip\n0,0,0,0.134,0,0.1\n");
  expect_refusal(palpate_on("check"), {"motion.csv: tool 'hand' starts in contact with body 'duct'"});
  replace("pivot = [0, -0.15, 0.02]", "pivot = [0, -0.15, -0.02]");
  write("motion.csv", "time,yaw,pitch,depth,roll,grip\n0,0,0,0.145,0,0.1\n");
  expect_refusal(palpate_on("check"), {"motion.csv: tool 'hand' starts in contact with body 'wire'"});
}

TEST_F(ToolsBadDuct, AMeshOfTetrahedraIsNoShell) {
  write_tet_mesh(make_block({0, 0, 0}, {1, 1, 1}, {1, 1, 1}), folder_ / "duct.msh");
  expect_refused({"duct.msh: it has solid elements of 4 nodes; a shell is made of triangles of 3 nodes alone"});
}

TEST_F(ToolsBadDuct, AShellIsSolvedThroughItsArchiveAlone) {
  const std::string solve = palpate_on("solve") + " --hold 18:0.001,0,0";
  EXPECT_EQ(run_program(solve + " --body duct").status, 0);
  expect_refusal(solve + " --body duct --method direct",
                 {"body 'duct' is a shell, and the direct method is for tetrahedra"});
  expect_refusal(solve + " --body wire", {"body 'wire' is a catheter, which has no static state to solve for"});
}

}  // namespace
}  // namespace palpate
