#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

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

TEST_F(ToolsCheckDynamic, SaysTheSameAsJson) {
  const std::string command = check(scene_);
  const ProgramResult text = testing::run_program(command), json = testing::run_program(command + " --json");
  ASSERT_EQ(json.status, 0) << json.err;
  const auto said = nlohmann::json::parse(json.out);
  EXPECT_NE(text.out.find("\nhash " + said["hash"].get<std::string>()), std::string::npos);
  ASSERT_EQ(said["bodies"].size(), 1u);
  EXPECT_EQ(said["bodies"][0]["name"], "cylinder");
  const auto& of_body = said["bodies"][0]["said"];
  EXPECT_NE(std::ranges::find(of_body, "motion: rk4, single precision, damping 5 1/s, gravity 0 0 0 m/s2"),
            of_body.end());
  for (const auto& line : of_body) EXPECT_NE(text.out.find(line.get<std::string>() + "\n"), std::string::npos) << line;
  EXPECT_GT(said["bodies"][0]["memory"][0]["bytes"], 1000);
  for (const auto& line : said["left_out"])
    EXPECT_NE(text.out.find("\n  " + line.get<std::string>() + "\n"), std::string::npos) << line;
  std::size_t warnings = 0;
  for (auto at = text.out.find("\nwarning: "); at != std::string::npos; at = text.out.find("\nwarning: ", at + 1))
    ++warnings;
  EXPECT_EQ(said["warnings"].size(), warnings);
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

TEST_F(ToolsCheckDynamic, ARuleThatMovingTissueDoesNotKnowIsPointedOut) {
  const std::string warning = "warning: body 'cylinder' moves: it is touched as under rule \"barycentric\"";
  expect_line(testing::run_program(check(scene_ + "[contact]\nrule = \"alpha\"\n")), warning);
  const ProgramResult other = testing::run_program(check(scene_ + "[contact]\nrule = \"barycentric\"\n"));
  EXPECT_EQ(other.out.find(warning), std::string::npos);
}

}  // namespace
}  // namespace palpate
