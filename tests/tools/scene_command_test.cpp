#include <gtest/gtest.h>

#include "common/mesh/generators.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/tool/trajectory.hpp"
#include "tests/bus/domain.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/tissue_table.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

/// A block of 100 x 80 x 60 mm held at its bottom, a kidney of which some is fat.
class ToolsScene : public ::testing::Test {
 protected:
  ToolsScene() {
    TetMesh mesh = make_block({0, 0, 0}, {0.1, 0.08, 0.06}, {4, 4, 4});
    mesh.groups = {{"attachment", mesh.groups.at("bottom")}};
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
      mesh.groups[mesh.nodes[mesh.tetrahedra[t][0]].x() < 0.04 ? "fat" : "kidney"].tetrahedra.push_back(
          static_cast<int>(t));
    write_tet_mesh(mesh, folder_ / "block.msh");
    const auto made = run_program(program("palpate") + " scene " + (folder_ / "block.msh").string() +
                                  " --tissue kidney -o " + scene());
    EXPECT_EQ(made.status, 0) << made.err;
  }
  std::string scene() const { return folder_ / "block.toml"; }
  ProgramResult checked() const { return run_program(program("palpate") + " check " + scene()); }
  void change(const std::string& name, const std::string& from, const std::string& to) const {
    const std::string text = replaced(text_of(folder_ / name), from, to);
    std::ofstream(folder_ / name) << text;
  }
  void expect_warning(const std::string& said) const {
    const auto result = checked();
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find(said), std::string::npos) << result.out;
  }

  const OwnFolder folder_{"scene-command"};
};

TEST_F(ToolsScene, TheSceneOfAMeshPassesTheCheckAndItsToolPresses) {
  const auto result = checked();
  EXPECT_EQ(result.status, 0) << result.err;
  const std::size_t warning = result.out.find("warning:");
  ASSERT_NE(warning, std::string::npos) << result.out;
  EXPECT_NE(result.out.find("is of other materials than its own", warning), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("100 % of what can be touched"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("warning:", warning + 1), std::string::npos) << result.out;
  for (const char* said : {"size: 100 x 80 x 60 mm, 480 ml", "dihedral angles: smallest", "young 10000 Pa",
                           "in group 'fat': young 3000 Pa", "group 'attachment', 25 nodes"})
    EXPECT_NE(result.out.find(said), std::string::npos) << said << "\n" << result.out;
  EXPECT_EQ(result.out.find("in group 'kidney'"), std::string::npos) << result.out;
  const auto run =
      run_program(fmt::format("{} run {} --seconds 3.5 --domain {}", program("palpate"), scene(), own_domain()));
  ASSERT_EQ(run.status, 0) << run.err;
  const std::size_t at = run.out.find("largest force ");
  ASSERT_NE(at, std::string::npos) << run.out;
  EXPECT_GT(std::stod(run.out.substr(at + 14)), 0.03) << run.out;
}

// Deeper than half the tip's radius tissue is not linear any more.
TEST_F(ToolsScene, TheFirstPressIsNoDeeperThanHalfTheTipsRadius) {
  const auto deepest = [&](const std::string& options) {
    const auto made = run_program(fmt::format("{} scene {} --tissue kidney{} -o {}", program("palpate"),
                                              (folder_ / "block.msh").string(), options, scene()));
    EXPECT_EQ(made.status, 0) << made.err;
    const Trajectory motion = load_trajectory(folder_ / "block_motion.csv");
    return motion.at(4).depth - motion.at(1).depth - 0.002;  // begins 2 mm off
  };
  EXPECT_NEAR(deepest(""), 0.003, 2e-6);
  EXPECT_NEAR(deepest(" --radius 0.002"), 0.001, 2e-6);
  EXPECT_NEAR(deepest(" --radius 0.02"), std::sqrt(0.02) / 40, 2e-6) << "a fortieth of the diagonal";
  EXPECT_NEAR(deepest(" --press 0.008"), 0.008, 2e-6);
  testing::expect_refusal(fmt::format("{} scene {} --tissue kidney --press 8 -o {}", program("palpate"),
                                      (folder_ / "block.msh").string(), scene()),
                          {"--press: 8e+03 mm are more than the body's size, 141 mm: it is in metres"});
}

TEST_F(ToolsScene, ASurfaceToBeLookedAtComesInByItself) {
  // Two sides of the block.
  const auto written = [&](const char* name, double unit) {
    std::ofstream out(folder_ / name);
    out << "mtllib look.mtl\nusemtl bile\n";
    for (const double x : {0.0, 0.1})
      for (const double y : {0.0, 0.08})
        for (const double z : {0.0, 0.06}) out << fmt::format("v {} {} {}\n", x / unit, y / unit, z / unit);
    out << "f 1 2 3\nf 2 4 3\nf 5 7 6\nf 6 7 8\n";
    return (folder_ / name).string();
  };
  std::ofstream(folder_ / "look.mtl") << "newmtl bile\nKd 0.1 0.4 0.1\n";
  const auto made = [&](const std::string& surface) {
    return run_program(fmt::format("{} scene {} --tissue kidney --visual {} -o {}", program("palpate"),
                                   (folder_ / "block.msh").string(), surface, scene()));
  };
  for (const auto& [unit, scale] : {std::pair{0.001, "scale = 0.001"}, std::pair{1.0, "scale = 1"}}) {
    const auto result = made(written("look.obj", unit));
    ASSERT_EQ(result.status, 0) << result.err;
    const std::string text = text_of(scene());
    for (const char* const said : {"[body.visual]", "surface = \"look.obj\"", "materials = \"look.mtl\"", scale})
      EXPECT_NE(text.find(said), std::string::npos) << said << "\n" << text;
    EXPECT_EQ(checked().status, 0) << checked().err;
  }
  const auto inches = made(written("inches.obj", 0.0254));
  EXPECT_EQ(inches.status, 1);
  EXPECT_NE(inches.err.find("inches.obj: it does not lie about the mesh, neither in metres nor in millimetres"),
            std::string::npos)
      << inches.err;
}

TEST_F(ToolsScene, ATexturedSurfaceComesInWithItsImage) {
  for (const char* name : {"liver_visual.obj", "liver_visual.mtl", "liver_visual.png"})
    std::filesystem::copy(std::filesystem::path(PALPATE_SOURCE) / "scenes/meshes" / name, folder_ / name);
  const std::string mesh = std::filesystem::path(PALPATE_SOURCE) / "scenes/meshes/liver.msh";
  const auto made = [&] {
    return run_program(fmt::format("{} scene {} --tissue liver --visual {} -o {}", program("palpate"), mesh,
                                   (folder_ / "liver_visual.obj").string(), scene()));
  };
  ASSERT_EQ(made().status, 0) << made().err;
  EXPECT_NE(text_of(scene()).find("texture = \"liver_visual.png\""), std::string::npos) << text_of(scene());
  EXPECT_EQ(checked().status, 0) << checked().err;
  // Named as another program had it.
  change("liver_visual.mtl", "map_Kd liver_visual.png", "map_Kd -s 1 1 1 C:/textures/liver.jpg");
  EXPECT_EQ(made().status, 0) << made().err;
  EXPECT_EQ(checked().status, 0) << checked().err;
  std::filesystem::remove(folder_ / "liver_visual.png");
  const auto bare = made();
  EXPECT_EQ(bare.status, 1);
  EXPECT_NE(bare.err.find("liver_visual.mtl: its materials wear the image 'C:/textures/liver.jpg', and no PNG"),
            std::string::npos)
      << bare.err;
}

TEST_F(ToolsScene, ASurfaceInAMeshsPlaceIsToldHowAMeshIsMadeOfIt) {
  const std::string surface = folder_ / "ball.stl", words = "`palpate mesh SURFACE -o organ.msh` makes one of it";
  write_stl({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, surface);
  expect_refusal(program("palpate") + " scene " + surface + " --tissue liver -o " + (folder_ / "b.toml").string(),
                 {"ball.stl: this is a surface", words});
  expect_refusal(program("palpate") + " check " + surface, {"ball.stl: this is a surface", words});
  change("block.toml", "mesh = \"block.msh\"", "mesh = \"ball.stl\"");
  expect_refusal(program("palpate") + " check " + scene(), {"ball.stl: this is a surface", words});
}

TEST_F(ToolsScene, AMeshThatIsTooLargeIsWarnedOfAndItsMassIsThatOfTissue) {
  const std::string mesh = folder_ / "large.msh";
  write_tet_mesh(make_block({0, 0, 0}, {2, 0.1, 0.1}, {8, 1, 1}), mesh);
  const auto result = run_program(program("palpate") + " check " + mesh);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("warning: " + mesh + " is 2 m across: is it in metres?"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("21.2 kg at 1060 kg/m3"), std::string::npos) << result.out;
  const auto small = run_program(program("palpate") + " check " + (folder_ / "block.msh").string());
  EXPECT_EQ(small.out.find("warning:"), std::string::npos) << small.out;
}

TEST_F(ToolsScene, ATooLargeBodyIsWarnedOf) {
  change("block.toml", "name = \"kidney\"\n", "name = \"kidney\"\nscale = 20\n");
  expect_warning("is 2 m across: is its scale right?");
}

TEST_F(ToolsScene, ATipInMillimetresIsWarnedOf) {
  change("block.toml", "\nradius = 0.00", "\nradius = ");
  const auto result = checked();
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("starts in contact"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("of body 'kidney': it presses as a flat plate; is it in metres?"), std::string::npos)
      << result.out;
}

TEST_F(ToolsScene, APointerThatBeginsInTheBodyIsRefused) {
  const std::string inside = " --set tool.device=pointer --set tool.start=[0.05,0.04,0.05]";
  const auto result = run_program(program("palpate") + " check " + (folder_ / "block.toml").string() + inside);
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("starts in contact with body 'kidney' or inside it"), std::string::npos) << result.err;
}

TEST_F(ToolsScene, AModulusOfNoTissueIsWarnedOf) {
  change("block.toml", "young = 10000 ", "young = 6 ");
  expect_warning("young = 6 Pa, and tissue has");
}

TEST_F(ToolsScene, AToolThatNeverArrivesIsWarnedOf) {
  std::ofstream(folder_ / "block_motion.csv") << "time,yaw,pitch,depth,roll,grip\n0,0,0,0.05,0,0\n5,0,0,0.06,0,0\n";
  expect_warning("tool 'instrument' comes to no body on its way");
}

TEST_F(ToolsScene, AFileThatIsNoMotionIsNotReplacedByOne) {
  const std::string command = program("palpate") + " scene " + (folder_ / "block.msh").string() +
                              " --tissue kidney -o " + (folder_ / "own.toml").string();
  std::ofstream(folder_ / "own_motion.csv") << "dear diary\n";
  expect_refusal(command, {"own_motion.csv is", "would be replaced by"});
  EXPECT_EQ(text_of(folder_ / "own_motion.csv"), "dear diary\n");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "own.toml"));
  EXPECT_EQ(run_program(command + " --force").status, 0);
}

TEST_F(ToolsScene, WhatIsNotThereIsToldInASentence) {
  const std::string command =
      program("palpate") + " scene " + (folder_ / "block.msh").string() + " -o " + (folder_ / "b.toml").string();
  expect_refusal(command + " --tissue kidney --fixed top", {"block.msh: it has no group 'top'", "attachment"});
  expect_refusal(command, {"'block' is no tissue that is known", "liver, kidney"});
}

TEST(Tissues, EachValueLiesWithinItsPublishedRange) {
  for (const Tissue& tissue : tissues()) {
    EXPECT_LE(tissue.young_low, tissue.young) << tissue.name;
    EXPECT_LE(tissue.young, tissue.young_high) << tissue.name;
    EXPECT_FALSE(tissue.source.empty()) << tissue.name;
    EXPECT_EQ(find_tissue(tissue.name), &tissue);
  }
  EXPECT_EQ(find_tissue("stone"), nullptr);
}

}  // namespace
}  // namespace palpate
