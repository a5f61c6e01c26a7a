#include <gtest/gtest.h>

#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using testing::expect_refusal;
using testing::OwnFolder;
using testing::program;
using testing::ProgramResult;
using testing::replaced;

/// A hybrid cylinder, and what `palpate check` says of it.
class ToolsCheckDynamic : public ::testing::Test {
 protected:
  ToolsCheckDynamic() { setenv("PALPATE_CACHE", (folder_ / "cache").c_str(), 1); }
  ~ToolsCheckDynamic() override { unsetenv("PALPATE_CACHE"); }

  std::string check(const std::string& text) const {
    std::ofstream(folder_ / "scene.toml") << text;
    return program("palpate check") + " " + (folder_ / "scene.toml").string();
  }

  OwnFolder folder_{"check-dynamic"};
  const std::string scene_ = R"([[body]]
name = "cylinder"
mesh = ")" PALPATE_SOURCE R"(/scenes/meshes/cylinder_hybrid.msh"
model = "hybrid"
young = 1500
poisson = 0.4
fixed = [{ group = "top" }]
hybrid = { region = [{ group = "lower" }] }

[body.dynamic]
step = 0
)";
};

void expect_line(const ProgramResult& result, const std::string& line) {
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("\n" + line), std::string::npos) << "lacks '" << line << "': " << result.out;
}

TEST_F(ToolsCheckDynamic, SaysWhatMovesAndWhereItIsJoined) {
  const ProgramResult said = testing::run_program(check(scene_));
  expect_line(said,
              "  moving: 427 nodes, 1728 tetrahedra, 2394 edges, 50.0 % of the tetrahedra; joined to the "
              "quasi-static part at 61 nodes\n");
  expect_line(said, "  motion: rk4, single precision, damping 5 1/s, gravity 0 0 0 m/s2\n");
  expect_line(said, "  step: stable up to 0.0011");
  expect_line(said, "  body 'cylinder': does not tear by itself\n");
}

TEST_F(ToolsCheckDynamic, ATensorMassBodyMovesAsAWhole) {
  std::string text = replaced(scene_, "hybrid = { region = [{ group = \"lower\" }] }", "tearing = { threshold = 0.5 }");
  text = replaced(text, "\"hybrid\"", "\"tensor_mass\"");
  const ProgramResult said = testing::run_program(check(text));
  expect_line(said, "  moving: 793 nodes, 3456 tetrahedra, 4632 edges\n");
  expect_line(said, "  tearing: volume above 0.5\n");
}

TEST_F(ToolsCheckDynamic, AStepAboveTheBoundIsRefusedWithTheBound) {
  expect_refusal(check(replaced(scene_, "step = 0", "step = 0.01")),
                 {"body 'cylinder': a step of 0.01 s is not stable; the bound is 0.0011"});
  expect_line(testing::run_program(check(replaced(scene_, "step = 0", "step = 0.001"))), "  step: stable up to 0.0011");
}

TEST_F(ToolsCheckDynamic, RegionsThatLeaveNothingAreRefused) {
  expect_refusal(check(replaced(scene_, "{ group = \"lower\" }", "{ box = [[-1, -1, -1], [1, 1, 1]] }")),
                 {"body 'cylinder': [body.hybrid] leaves no quasi-static part"});
  expect_refusal(check(replaced(scene_, "{ group = \"lower\" }", "{ box = [[1, 1, 1], [2, 2, 2]] }")),
                 {"body 'cylinder': [[body.hybrid.region]] number 1 selects no element"});
}

TEST_F(ToolsCheckDynamic, ACauteryThatNeverBurnsIsPointedOut) {
  std::ofstream(folder_ / "rest.csv") << "time,yaw,pitch,depth,roll,grip\n0,0,0,0.1,0,1\n";
  const ProgramResult said = testing::run_program(check(
      scene_ + "[[tool]]\nname = \"knife\"\npivot = [0, 0, 1]\ntrajectory = \"rest.csv\"\ncautery = {}\njaws = {}\n"));
  expect_line(said, "warning: tool 'knife' has a cautery, and the pedal of its trajectory is never down\n");
  expect_line(said, "warning: tool 'knife' has jaws, and the grip of its trajectory never falls below 0.1 rad\n");
}

}  // namespace
}  // namespace palpate
