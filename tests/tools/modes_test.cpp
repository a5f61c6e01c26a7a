#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "common/mesh/generators.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using testing::OwnFolder;
using testing::program;
using testing::run_program;

/// A bar of 0.1 m, rho 1000 kg/m^3, that can move along itself alone, on its foot.
std::string bar(const OwnFolder& folder, const std::string& model, const std::string& more = "") {
  write_tet_mesh(make_block({0, 0, 0}, {0.01, 0.01, 0.1}, {1, 1, 40}), folder / "bar.msh");
  const std::string scene = folder / "bar.toml";
  std::ofstream(scene) << fmt::format(R"([[body]]
name = "bar"
mesh = "bar.msh"
model = "{}"
young = 10000
poisson = 0.0
density = 1000
[[body.fixed]]
box = [[-1, -1, -1], [1, 1, 1]]
axes = "xy"
[[body.fixed]]
box = [[-1, -1, -1e-6], [1, 1, 1e-6]]
{})",
                                      model, more);
  return scene;
}

std::vector<double> frequencies(const std::string& arguments) {
  const auto result = run_program(program("palpate") + " modes " + arguments);
  EXPECT_EQ(result.status, 0) << result.err;
  std::istringstream lines(result.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "mode,frequency_hz");
  std::vector<double> found;
  while (std::getline(lines, line)) found.push_back(std::stod(line.substr(line.find(',') + 1)));
  return found;
}

TEST(ToolsModes, ABarSwingsAsItsClosedFormSays) {
  const OwnFolder folder("modes");
  const double first = std::sqrt(10000.0 / 1000) / (4 * 0.1);
  for (const std::string model : {"quasi_static", "tensor_mass"}) {
    const auto found = frequencies(bar(folder, model) + " --count 3");
    ASSERT_EQ(found.size(), 3u);
    for (int m = 0; m < 3; ++m) EXPECT_NEAR(found[m], (2 * m + 1) * first, 0.003 * (2 * m + 1) * first) << model;
  }
}

TEST(ToolsModes, AreTheSameInJson) {
  const OwnFolder folder("modes");
  const std::string arguments = bar(folder, "tensor_mass") + " --count 3";
  const auto result = run_program(program("palpate") + " modes --json " + arguments);
  const auto json = nlohmann::json::parse(result.out);
  const auto table = frequencies(arguments);
  EXPECT_EQ(json["body"], "bar");
  ASSERT_EQ(json["frequency_hz"].size(), table.size());
  for (std::size_t m = 0; m < table.size(); ++m) EXPECT_NEAR(json["frequency_hz"][m], table[m], 1e-5 * table[m]);
}

TEST(ToolsModes, GoUpWithTheRootOfAStiffnessThatIsSet) {
  const OwnFolder folder("modes");
  const std::string arguments = bar(folder, "tensor_mass") + " --count 1";
  const auto soft = frequencies(arguments), stiff = frequencies(arguments + " --set body.young=40000");
  EXPECT_NEAR(stiff.at(0), 2 * soft.at(0), 1e-4 * soft.at(0));
}

TEST(ToolsModes, AHybridSwingsAsTheWholeBody) {
  const OwnFolder folder("modes");
  const auto whole = frequencies(bar(folder, "tensor_mass"));
  const auto hybrid = frequencies(bar(folder, "hybrid", "[[body.hybrid.region]]\nbox = [[-1, -1, 0.05], [1, 1, 1]]\n"));
  EXPECT_EQ(whole, hybrid);
}

TEST(ToolsModes, AShellsAreThoseOfItsArchive) {
  const OwnFolder folder("modes");
  setenv("PALPATE_CACHE", (folder / "cache").c_str(), 1);
  const std::string scene = PALPATE_SOURCE "/scenes/duct_poke.toml";
  const auto found = frequencies(scene + " --count 1");
  const auto precomputed = run_program(program("palpate") + " precompute " + scene);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(precomputed.out.find(fmt::format(" modes of {:.4g} to ", found[0])), std::string::npos) << precomputed.out;
}

/// Springs along the edges of a grid are another solid than the bar, stiffer or softer by no more than its edges say.
TEST(ToolsModes, SpringsSwingByTheirOwnStiffness) {
  const OwnFolder folder("modes");
  const double first = std::sqrt(10000.0 / 1000) / (4 * 0.1);
  const auto found = frequencies(bar(folder, "spring_mass") + " --count 2");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_GT(found[0], 0.5 * first);
  EXPECT_LT(found[0], 2 * first);
  EXPECT_NEAR(found[1] / found[0], 3, 0.05) << "a bar's, whatever its stiffness";
}

/// In its sleeve of 20 mm it slides freely and bends as a beam that is clamped about where the sleeve ends.
TEST(ToolsModes, ACatheterSlidesAndBendsAsABeam) {
  const OwnFolder folder("modes");
  const std::string scene = folder / "catheter.toml";
  std::ofstream(scene) << R"([[body]]
name = "catheter"
model = "catheter"
young = 1e7
density = 1000
[body.catheter]
tail = [0, 0, 0]
tip = [0.12, 0, 0]
radius = 0.001
particles = 121
sleeve = 0.02
)";
  const auto found = frequencies(scene + " --count 5");
  const double radius = 0.001, length = 0.1, root = 1.8751;
  const double beam = root * root / (2 * std::numbers::pi * length * length) * radius / 2 * std::sqrt(1e7 / 1000);
  ASSERT_EQ(found.size(), 5u);
  EXPECT_LT(found[0], 0.05 * beam);
  EXPECT_NEAR(found[1], beam, 0.03 * beam);
  EXPECT_NEAR(found[2], beam, 0.03 * beam) << "in both planes";
  EXPECT_NEAR(found[3], 6.2669 * beam, 0.03 * 6.2669 * beam);
}

/// A beam along x, clamped where that is 0. `more`: of the body.
std::string beam(const OwnFolder& folder, const TetMesh& mesh, const std::string& more) {
  write_tet_mesh(mesh, folder / "beam.msh");
  const std::string scene = folder / "beam.toml";
  std::ofstream(scene) << fmt::format(R"([[body]]
name = "beam"
mesh = "beam.msh"
young = 10000
{}
[[body.fixed]]
box = [[-1, -1, -1], [1e-6, 1, 1]]
)",
                                      more);
  return scene;
}

/// [Hz] of the first mode of Euler and Bernoulli's beam with a square section, E 10 kPa and 1,000 kg/m^3.
double first_of_beam(double length, double side) {
  const double root = 1.8751;
  return root * root / (2 * std::numbers::pi * length * length) * side * std::sqrt(10000.0 / 1000 / 12);
}

/// Whose tensors are of quadratic elements, by default: linear ones on this mesh are half as fast again.
TEST(ToolsModes, ASlenderBeamAtRestSwingsAsItsTensorsBend) {
  const OwnFolder folder("modes");
  const std::string scene =
      beam(folder, make_block({0, 0, 0}, {0.2, 0.01, 0.01}, {20, 1, 1}), "poisson = 0.0\ndensity = 1000");
  const double first = first_of_beam(0.2, 0.01);
  const auto found = frequencies(scene + " --count 2");
  ASSERT_EQ(found.size(), 2u);
  for (const double f : found) EXPECT_NEAR(f, first, 0.03 * first);
  EXPECT_GT(frequencies(scene + " --count 1 --set body.offline.element=p1").at(0), 1.2 * first);
}

TEST(ToolsModes, AveragedStrainTakesTheLockingOutOfABeam) {
  const OwnFolder folder("modes");
  const TetMesh mesh = make_block({0, 0, 0}, {0.1, 0.01, 0.01}, {20, 2, 2});
  const auto first = [&](const char* element) {
    const std::string more =
        fmt::format("model = \"tensor_mass\"\npoisson = 0.49\n[body.dynamic]\nelement = \"{}\"", element);
    return frequencies(beam(folder, mesh, more) + " --count 1").at(0);
  };
  const double bending = first_of_beam(0.1, 0.01);
  EXPECT_NEAR(first("nodal_strain"), bending, 0.04 * bending);
  EXPECT_GT(first("linear"), 1.25 * bending);
}

}  // namespace
}  // namespace palpate
