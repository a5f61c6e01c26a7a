#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
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

TEST(ToolsModes, WhatHasNoneIsRefusedInWords) {
  const OwnFolder folder("modes");
  testing::expect_refusal(program("palpate") + " modes " + bar(folder, "spring_mass"), {"'bar'", "springs"});
  testing::expect_refusal(
      program("palpate") + " modes " PALPATE_SOURCE "/scenes/catheter_insertion.toml --body catheter", {"particles"});
}

}  // namespace
}  // namespace palpate
