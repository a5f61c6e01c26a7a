// Archives and readings are listed and removed, and nothing else is.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using testing::kLinear;
using testing::LoopbackScene;
using testing::OwnFolder;
using testing::program;
using testing::run_program;

class ToolsCache : public ::testing::Test {
 protected:
  void SetUp() override { setenv("PALPATE_CACHE", (folder_ / "cache").c_str(), 1); }
  void TearDown() override { unsetenv("PALPATE_CACHE"); }

  std::string cache(const std::string& words) const {
    const auto result = run_program(program("palpate") + " cache " + words);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out;
  }
  void write(const std::string& name) const { std::ofstream(folder_ / "cache" / name) << "no archive"; }
  std::size_t files(const std::string& folder = "cache") const {
    const auto is_file = [](const fs::directory_entry& entry) { return !entry.is_directory(); };
    return static_cast<std::size_t>(std::ranges::count_if(fs::directory_iterator(folder_ / folder), is_file));
  }

  OwnFolder folder_{"cache"};
};

TEST_F(ToolsCache, ListsWhatIsThereAndRemovesWhatIsOfNoUse) {
  EXPECT_NE(cache("list").find("cache: 0 archives"), std::string::npos) << "no folder yet";
  const LoopbackScene scene("cache", kLinear);
  const auto made = run_program(program("palpate") + " precompute --json " + scene.scene());
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(nlohmann::json::parse(made.out)["body"], "block");
  EXPECT_EQ(nlohmann::json::parse(made.out)["up_to_date"], false);
  ASSERT_EQ(files(), 1u);
  const std::string hash(32, 'a');
  write("old-" + hash + ".h5");
  write("notes.txt");
  write("short-abc.h5");
  fs::create_symlink("/etc/passwd", folder_ / "cache" / ("link-" + hash + ".h5"));

  const std::string listed = cache("list");
  EXPECT_NE(listed.find("old-" + hash + ".h5  (of no use to this version)"), std::string::npos) << listed;
  EXPECT_NE(listed.find("cache: 2 archives"), std::string::npos) << listed;
  EXPECT_EQ(listed.find("passwd"), std::string::npos);
  const auto json = nlohmann::json::parse(cache("list --json"));
  ASSERT_EQ(json["archives"].size(), 2u) << json;
  EXPECT_EQ(json["archives"][0]["body"], "block");
  EXPECT_EQ(json["archives"][0]["usable"], true);
  EXPECT_EQ(json["archives"][1]["usable"], false);
  EXPECT_EQ(cache("list " + scene.scene()), listed) << "its archives are there too";

  EXPECT_NE(cache("clean --days 1").find(" 0 archives removed"), std::string::npos) << "all are new";
  EXPECT_NE(cache("clean --unusable").find(" 1 archives removed"), std::string::npos);
  EXPECT_EQ(files(), 4u);
  EXPECT_NE(cache("clean").find(" 1 archives removed"), std::string::npos);
  EXPECT_EQ(files(), 3u) << "what is no archive stays";
}

TEST_F(ToolsCache, ListsAndRemovesReadingsOfMeshFiles) {
  const LoopbackScene scene("cache-readings", kLinear);
  ASSERT_EQ(run_program(program("palpate") + " check " + scene.scene()).status, 0);
  ASSERT_EQ(files("cache/readings"), 1u);
  write("readings/" + std::string(32, 'a'));
  write("readings/notes.txt");
  const std::string listed = cache("list");
  EXPECT_NE(listed.find("cache/readings: 2 readings of mesh files, "), std::string::npos) << listed;

  EXPECT_EQ(cache("clean --days 1").find("readings"), std::string::npos) << "all are new";
  EXPECT_NE(cache("clean --unusable").find("cache/readings: 1 readings of mesh files removed, "), std::string::npos);
  EXPECT_NE(cache("clean").find("cache/readings: 1 readings of mesh files removed, "), std::string::npos);
  EXPECT_EQ(files("cache/readings"), 1u) << "what is no reading stays";
  EXPECT_EQ(cache("list").find("readings"), std::string::npos);
}

}  // namespace
}  // namespace palpate
