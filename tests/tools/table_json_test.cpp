// What `palpate stability` writes as a table, it prints with --json, a line a row.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using nlohmann::json;
using testing::OwnFolder;
using testing::program;
using testing::run_program;

std::vector<json> lines_of(const std::string& out) {
  std::vector<json> lines;
  std::istringstream in(out);
  for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
  return lines;
}

long rows_of(const std::filesystem::path& table) {
  const std::string text = testing::text_of(table);
  return std::count(text.begin(), text.end(), '\n') - 1;
}

TEST(ToolsTables, AStabilityCaseIsALine) {
  const OwnFolder folder("stability-json");
  const auto run = run_program(
      fmt::format("{} stability --quick --only sliver --json -o {}", program("palpate"), folder.path().string()));
  ASSERT_EQ(run.status, 0) << run.err;
  const std::vector<json> lines = lines_of(run.out);
  EXPECT_GT(lines.size(), 0u);
  EXPECT_EQ(static_cast<long>(lines.size()), rows_of(folder / "stability.csv"));
  for (const json& line : lines) {
    EXPECT_EQ(line["case"], "sliver");
    EXPECT_NE(line["outcome"], "failed");
    EXPECT_TRUE(line["max_force"].is_number());
  }
}

}  // namespace
}  // namespace palpate
