#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/sanitized.hpp"
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

TEST_F(ToolsCheckDynamic, TakesWhatIsSetInPlaceOfTheFilesOwn) {
  const std::string set = " --set body.dynamic.damping=7 --set body.young=6000";
  expect_line(testing::run_program(check(scene_) + set),
              "  motion: rk4, single precision, damping 7 1/s, gravity 0 0 0 m/s2\n");
  expect_refusal(check(scene_) + " --set body.yuong=6000", {"--set body.yuong=6000", "did you mean 'young'?"});
  expect_refusal(
      program("palpate check") + " " PALPATE_SOURCE "/scenes/meshes/cylinder_hybrid.msh --set body.young=6000",
      {"--set is for a scene"});
}

TEST_F(ToolsCheckDynamic, WarnsOfAveragedStrainUnderAWideTool) {
  const std::string averaged = scene_ + "element = \"nodal_strain\"\n", off = "elements of averaged strain is up to",
                    swings = "elements of averaged strain can swing";
  const auto tool = [](const std::string& radius) {
    return "[[tool]]\nname = \"probe\"\npivot = [0, 0, 0.5]\nradius = " + radius +
           "\ntrajectory = \"" PALPATE_SOURCE "/scenes/trajectories/cylinder_hybrid.csv\"\n";
  };
  const auto warns = [&](const std::string& scene, const std::string& warning, const std::string& friction = "0.1") {
    const ProgramResult said = testing::run_program(check(scene) + " --set contact.friction=" + friction);
    EXPECT_EQ(said.status, 0) << said.err;
    return said.out.find(warning) != std::string::npos;
  };
  EXPECT_FALSE(warns(averaged, off)) << "nothing presses it";
  EXPECT_FALSE(warns(averaged + tool("0.005"), off)) << "an edge is as wide";
  EXPECT_FALSE(warns(scene_ + tool("0.03"), off));
  EXPECT_TRUE(warns(averaged + tool("0.03"), off));
  EXPECT_FALSE(warns(averaged, swings, "1"));
  EXPECT_FALSE(warns(averaged + tool("0.005"), swings));
  EXPECT_TRUE(warns(averaged + tool("0.005"), swings, "1"));
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
  for (const auto& line : of_body) {
    const auto sentence = line.get<std::string>();
    const bool timed = sentence.starts_with("cost: ") || sentence.starts_with("fits a tick: ");
    EXPECT_TRUE(timed || text.out.find(sentence + "\n") != std::string::npos) << line;
  }
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

// As the static solve of the command line has it.
TEST_F(ToolsCheckDynamic, SaysHowFarTheBodySinksUnderItsGravity) {
  EXPECT_EQ(testing::run_program(check(scene_)).out.find("  sag: "), std::string::npos) << "no gravity";
  const std::string heavy = replaced(scene_, "step = 0", "step = 0\ngravity = [0, 0, -9.81]");
  const ProgramResult said = testing::run_program(check(heavy));
  const auto at = said.out.find("  sag: ");
  ASSERT_NE(at, std::string::npos) << said.out;
  EXPECT_NE(said.out.find(" under its loads and weight", at), std::string::npos);
  const double sag_mm = std::stod(said.out.substr(at + 7));
  const ProgramResult solved = testing::run_program(program("palpate") + " solve " + (folder_ / "scene.toml").string() +
                                                    " --method direct --gravity 0 0 -9.81 --json");
  EXPECT_NEAR(sag_mm, 1e3 * nlohmann::json::parse(solved.out)["max_displacement_m"].get<double>(), 0.01 * sag_mm);
  const ProgramResult soft = testing::run_program(check(replaced(heavy, "young = 1500", "young = 300")));
  EXPECT_NE(soft.out.find("of its diagonal under its loads and weight: linear tissue"), std::string::npos) << soft.out;
}

// Tissue a million times as stiff takes a thousand times the steps.
TEST_F(ToolsCheckDynamic, ATickThatTakesLongerThanItLastsIsPointedOut) {
  const std::string warning =
      "where 0.8 of 1 ms are the tissue's: time in the tissue falls behind; what would fit is tissue ";
  const ProgramResult soft = testing::run_program(check(scene_));
  expect_line(soft, "  cost: 1 steps a tick, ");
  if (!testing::kSanitized) {  // a sanitizer's tissue may not fit
    EXPECT_NE(soft.out.find("  fits a tick: up to "), std::string::npos) << soft.out;
    EXPECT_EQ(soft.out.find(warning), std::string::npos) << soft.out;
  }
  const ProgramResult stiff = testing::run_program(check(replaced(scene_, "young = 1500", "young = 1.5e9")));
  EXPECT_NE(stiff.out.find(warning), std::string::npos) << stiff.out;
  EXPECT_EQ(stiff.out.find("  fits a tick: "), std::string::npos) << stiff.out;
}

/// A body that moves as a whole, and a probe with what is set of it.
class ToolsCheckContact : public ToolsCheckDynamic {
 protected:
  ToolsCheckContact() {
    std::ofstream(folder_ / "rest.csv") << "time,yaw,pitch,depth,roll,grip\n0,0,0,0.1,0,1\n0.1,0,0,0.3,0,1\n";
  }
  static std::string with_probe(const std::string& body, const std::string& set) {
    return body + "[[tool]]\nname = \"probe\"\npivot = [0.2, 0, 1]\ntrajectory = \"rest.csv\"\n" + set;
  }
  const std::string whole_ =
      replaced(replaced(scene_, "hybrid = { region = [{ group = \"lower\" }] }", ""), "\"hybrid\"", "\"tensor_mass\"");
  const std::string tried_ =
      "  stable contact of tips: tried from 100 to 1e+08 Pa, Poisson's ratio up to 0.45, edges of 0.04 to 50 mm, tips "
      "of 0.2 to 4 edges, 0.3 radii deep";
};

TEST_F(ToolsCheckContact, BeyondWhatWasTriedIsPointedOut) {
  const std::string text = with_probe(whole_, "radius = 0.0005\nshaft_radius = 0.02\n");
  const ProgramResult said = testing::run_program(check(text));
  expect_line(said, tried_);
  expect_line(said, "warning: body 'cylinder': the tip of 'probe' over the mean edge is 0.");
  expect_line(said, "warning: body 'cylinder': the shaft of 'probe' over the mean edge is ");
  expect_line(said, "warning: body 'cylinder': the largest speed of 'probe' is ");
  const ProgramResult stiff = testing::run_program(
      check(replaced(replaced(text, "young = 1500", "young = 1e9"), "poisson = 0.4", "poisson = 0.47")));
  expect_line(stiff,
              "warning: body 'cylinder': young is 1e+09 Pa, and contact with moving tissue was found stable from "
              "100 to 1e+08 Pa");
  expect_line(stiff, "warning: body 'cylinder': poisson is 0.47, and contact with moving tissue was found stable");
}

TEST_F(ToolsCheckContact, IsSaidToHaveBeenTriedOnlyWhereItWas) {
  const ProgramResult tried = testing::run_program(check(with_probe(whole_, "shaft_radius = 0.001\n")));
  expect_line(tried, tried_);
  EXPECT_EQ(tried.out.find("the shaft of 'probe'"), std::string::npos) << "narrower than an edge: " << tried.out;
  const auto expect_untried = [&](const std::string& text, const std::string& what) {
    const ProgramResult said = testing::run_program(check(text));
    expect_line(said, "  stable contact: not tried " + what + ": try it by palpate stability SCENE\n");
    EXPECT_EQ(said.out.find("tried from"), std::string::npos) << said.out;
  };
  expect_untried(with_probe(whole_, "[contact]\nrule = \"barycentric\"\n"), "under rule \"barycentric\"");
  expect_untried(with_probe(scene_, ""), "with a hybrid body");
  expect_untried(with_probe(replaced(whole_, "\"tensor_mass\"", "\"spring_mass\""), ""), "with a spring_mass body");
  expect_untried(with_probe(whole_ + "corotational = true\n", ""), "with elements that turn with the tissue");
  const ProgramResult averaged = testing::run_program(check(with_probe(whole_ + "element = \"nodal_strain\"\n", "")));
  expect_line(averaged, "  stable contact of tips: with strain averaged at the nodes not of all");
  const std::string by_mesh = whole_ + "element = \"nodal_strain\"\n";
  expect_untried(with_probe(by_mesh, "[contact]\nrule = \"barycentric\"\n"), "under rule \"barycentric\"");
  const std::string stiff = replaced(by_mesh, "young = 1500", "young = 1e9");
  expect_line(testing::run_program(check(with_probe(stiff, ""))), "warning: body 'cylinder': young is 1e+09 Pa");
}

TEST_F(ToolsCheckDynamic, AContrastBeyondRoundingIsRefusedAsThat) {
  const std::string region = "\n[[body.material]]\ngroup = \"lower\"\nyoung = ";
  expect_refusal(check(scene_ + region + "1.5e18\n"),
                 {"body 'cylinder': its materials have Young's moduli from 1.5e+03 to 1.5e+18 Pa, a contrast of 1e+15: "
                  "more than 1e+10"});
  EXPECT_EQ(testing::run_program(check(scene_ + region + "1.5e12\n")).status, 0);
}

TEST_F(ToolsCheckDynamic, AMeshAloneIsSaidToBeWhatItIsAndTakes) {
  const std::string mesh = PALPATE_SOURCE "/scenes/meshes/cylinder_hybrid.msh";
  const ProgramResult said = testing::run_program(program("palpate check") + " " + mesh);
  expect_line(said, "  793 nodes, 3456 tetrahedra; surface: ");
  expect_line(said, "  size: ");
  expect_line(said, "  dihedral angles: smallest ");
  expect_line(said, "  groups: 'bottom' with 61 nodes, ");  // by names alone: the file numbers them too
  expect_line(
      said,
      "  as a quasi-static body, touchable where it is not held, tensors from quadratic elements: precompute takes ");
  EXPECT_NE(said.out.find("archive: compliance among touchable dofs"), std::string::npos);
  const ProgramResult json = testing::run_program(program("palpate check") + " " + mesh + " --json");
  EXPECT_EQ(nlohmann::json::parse(json.out)["mesh"], mesh);
  std::ofstream(folder_ / "none.msh") << "no mesh\n";
  expect_refusal(program("palpate check") + " " + (folder_ / "none.msh").string(), {"none.msh: "});
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
