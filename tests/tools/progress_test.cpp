#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "common/mesh/generators.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using testing::OwnFolder;
using testing::program;
using testing::run_program;

/// What precomputing a block from nothing says of its progress.
std::string said_with(const std::string& option) {
  const OwnFolder folder("progress");
  write_tet_mesh(make_block({0, 0, 0}, {0.1, 0.1, 0.1}, {4, 4, 4}), folder / "block.msh");
  const std::string scene = folder / "block.toml";
  std::ofstream(scene) << R"([[body]]
name = "block"
mesh = "block.msh"
young = 5000
poisson = 0.4
[[body.fixed]]
box = [[-1, -1, -1e-6], [1, 1, 1e-6]]
)";
  const auto result = run_program(program("palpate") + " precompute " + option + " " + scene);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("computed and written"), std::string::npos) << "results are told all the same";
  return result.err;
}

TEST(ToolsProgress, QuietSaysNothingOfTheWorkAndVerboseEachStage) {
  EXPECT_EQ(said_with("--quiet"), "");
  EXPECT_EQ(said_with("-q"), "");
  const std::string all = said_with("-v");
  EXPECT_GT(std::ranges::count(all, '\n'), 2) << all;
  EXPECT_NE(run_program(program("palpate") + " precompute -q -v scene.toml").status, 0);
}

}  // namespace
}  // namespace palpate
