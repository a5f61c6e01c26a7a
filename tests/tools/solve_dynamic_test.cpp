#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/mesh/generators.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tests/tools/program_result.hpp"

/// Offline solves against closed forms: stresses, and motions.
namespace palpate {
namespace {

using testing::expect_refusal;
using testing::OwnFolder;
using testing::program;
using testing::run_program;

class ToolsSolveForms : public ::testing::Test {
 protected:
  void SetUp() override { setenv("PALPATE_CACHE", (folder_ / "cache").c_str(), 1); }

  std::string write_scene(const std::string& text) const {
    std::ofstream(folder_ / "scene.toml") << text;
    return (folder_ / "scene.toml").string();
  }

  /// A bar 20 x 20 x 60 mm whose bottom slides, held so that nothing keeps it from becoming wider.
  /// `more`: of the body; quadratic elements unless it says otherwise.
  std::string bar(const std::string& more = "") const {
    write_tet_mesh(make_block({0, 0, 0}, {0.02, 0.02, 0.06}, {2, 2, 6}), folder_ / "bar.msh");
    return write_scene(R"([[body]]
name = "bar"
mesh = "bar.msh"
young = 5000
poisson = 0.3
fixed = [{ group = "bottom", axes = "z" }, { nodes = [0], axes = "xy" }, { nodes = [2], axes = "y" }]
)" + more);
  }

  /// The numbers of a list in the VTU file that the command writes.
  std::vector<double> solved(const std::string& command, const std::string& name) const {
    const std::string file = folder_ / "out.vtu";
    const auto result = run_program(command + " --vtu " + file);
    EXPECT_EQ(result.status, 0) << result.err;
    const std::string text = testing::text_of(file);
    const auto begin = text.find('\n', text.find("Name=\"" + name + "\"")) + 1;
    std::istringstream numbers(text.substr(begin, text.find("</DataArray>", begin) - begin));
    std::vector<double> list;
    for (double x; numbers >> x;) list.push_back(x);
    return list;
  }

  OwnFolder folder_{"solve-forms"};
};

constexpr const char* kElements[] = {"", "offline = { element = \"p1\" }\n", "offline = { element = \"p2\" }\n",
                                     "offline = { element = \"p2\", refine = 1 }\n"};

TEST_F(ToolsSolveForms, APulledBarHasOneStressEverywhere) {
  for (const std::string elements : kElements) {
    const std::string command = program("palpate solve") + " " + bar(elements) + " --method direct --pressure top:-700";
    const auto stress = solved(command, "stress"), von_mises = solved(command, "von_mises");
    ASSERT_EQ(von_mises.size(), 144u);
    ASSERT_EQ(stress.size(), 6 * von_mises.size());
    const std::array<double, 6> expected{0, 0, 700, 0, 0, 0};
    for (std::size_t i = 0; i < stress.size(); ++i) EXPECT_NEAR(stress[i], expected[i % 6], 1e-6) << elements << i;
    for (const double s : von_mises) EXPECT_NEAR(s, 700, 1e-6);
  }
}

TEST_F(ToolsSolveForms, PressureFromAllSidesIsPressureInside) {
  for (const std::string elements : kElements) {
    std::string command = program("palpate solve") + " " + bar(elements) + " --method direct";
    for (const char* side : {"top", "x0", "x1", "y0", "y1"}) command += fmt::format(" --pressure {}:300", side);
    const auto stress = solved(command, "stress"), von_mises = solved(command, "von_mises");
    for (std::size_t i = 0; i < stress.size(); ++i) EXPECT_NEAR(stress[i], i % 6 < 3 ? -300 : 0, 1e-6) << elements << i;
    for (const double s : von_mises) EXPECT_NEAR(s, 0, 1e-6);
  }
}

TEST_F(ToolsSolveForms, ABarStretchesByItsOwnWeightAsItsClosedFormSays) {
  // (rho g / 2 E) L^2 at its end, hanging from its bottom
  const double expected = 1060 * 9.81 * 0.06 * 0.06 / (2 * 5000);
  for (const std::string elements : kElements) {
    const auto result = run_program(program("palpate solve") + " " + bar("density = 1060\n" + elements) +
                                    " --method direct --set body.poisson=0 --gravity 0 0 9.81 --json");
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NEAR(nlohmann::json::parse(result.out)["max_displacement_m"].get<double>(), expected, 5e-3 * expected)
        << elements;
  }
}

TEST_F(ToolsSolveForms, AForceOnWhatIsFixedMovesNothing) {
  for (const std::string elements : kElements)
    for (const char* method : {"direct", "tensors"}) {
      const auto result = run_program(
          fmt::format("{} solve {} --method {} --force \"0:0,0,2\" --json", program("palpate"), bar(elements), method));
      ASSERT_EQ(result.status, 0) << result.err;
      EXPECT_LT(nlohmann::json::parse(result.out)["max_displacement_m"].get<double>(), 1e-12) << elements << method;
    }
}

TEST_F(ToolsSolveForms, APressureThatPressesNothingIsRefused) {
  const std::string command = program("palpate solve") + " " + bar() + " --method direct --pressure ";
  expect_refusal(command + "nowhere:3", {"--pressure", "nowhere"});
  expect_refusal(command + "top:high", {"--pressure", "'high' is not a number"});
}

/// The same bar, moving, clamped at its bottom, in a weight across it from the first tick on.
class ToolsSolveDynamic : public ToolsSolveForms {
 protected:
  std::string moving_bar() const {
    write_tet_mesh(make_block({0, 0, 0}, {0.02, 0.02, 0.06}, {2, 2, 6}), folder_ / "bar.msh");
    return write_scene(R"([[body]]
name = "bar"
mesh = "bar.msh"
model = "tensor_mass"
young = 5000
poisson = 0.3
fixed = [{ group = "bottom" }]
dynamic = { damping = 0, gravity = [0.5, 0, 0] }
)");
  }

  /// x of one node from time to time.
  std::vector<std::array<double, 2>> course(const std::string& command, int node) const {
    const std::string file = folder_ / "motion.csv";
    const auto result = run_program(command + " --csv " + file);
    EXPECT_EQ(result.status, 0) << result.err;
    std::istringstream lines(testing::text_of(file));
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "time,node,x,y,z,ux,uy,uz,vx,vy,vz");
    std::vector<std::array<double, 2>> rows;
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      std::vector<double> row;
      for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
      if (static_cast<int>(row[1]) == node) rows.push_back({row[0], row[5]});
    }
    return rows;
  }
};

TEST_F(ToolsSolveDynamic, ABarSwingsAboutItsSagInThePeriodOfItsFirstMode) {
  const std::string scene = moving_bar();
  const auto modes = run_program(program("palpate modes") + " " + scene + " --json");
  const double frequency = nlohmann::json::parse(modes.out)["frequency_hz"][0];
  const auto rest = run_program(program("palpate solve") + " " + scene + " --method direct --gravity 0.5 0 0 --json");
  const auto sag = nlohmann::json::parse(rest.out);
  const double period = 1 / frequency;
  const auto rows = course(fmt::format("{} {} --dynamic --seconds {} --every 0.001 --precision double",
                                       program("palpate solve"), scene, 2.6 * period),
                           sag["max_displacement_node"]);
  ASSERT_GT(rows.size(), 100u);
  std::vector<double> crossings;  // of the sag, on the way out
  const double middle = sag["max_displacement_m"];
  double most = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto [t0, a] = rows[i - 1];
    const auto [t1, b] = rows[i];
    most = std::max(most, b);
    if (a < middle && b >= middle) crossings.push_back(t0 + (t1 - t0) * (middle - a) / (b - a));
  }
  ASSERT_GE(crossings.size(), 3u);
  EXPECT_NEAR((crossings[2] - crossings[0]) / 2, period, 0.01 * period);
  EXPECT_NEAR(most, 2 * middle, 0.03 * middle);
}

TEST_F(ToolsSolveDynamic, ItsStatesAreFilesWithTheListOfTheirTimes) {
  const std::string command = program("palpate solve") + " " + moving_bar() + " --dynamic --seconds 0.1 ";
  const auto states = folder_ / "states";
  const auto said = run_program(command + "--every 0.05 --states " + states.string() + " --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(nlohmann::json::parse(said.out)["states"], 2);
  EXPECT_TRUE(std::filesystem::exists(states / "state_00001.vtu"));
  EXPECT_NE(testing::text_of(states / "states.pvd").find("timestep=\"0.1\" file=\"state_00001.vtu\""),
            std::string::npos);
  expect_refusal(command + "--states " + states.string(), {"states: is there already"});
  expect_refusal(command + "--every 0.0001", {"--every: a tick of this scene lasts 0.001 s"});
  expect_refusal(program("palpate solve") + " " + bar() + " --dynamic --seconds 1", {"body 'bar' is a quasi_static"});
}

}  // namespace
}  // namespace palpate
