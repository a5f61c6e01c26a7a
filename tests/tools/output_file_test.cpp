#include <gtest/gtest.h>

#include "tests/tools/program_result.hpp"

/// What a command writes never takes the place of what is not its own.
namespace palpate {
namespace {

namespace fs = std::filesystem;
using testing::LoopbackScene;
using testing::program;
using testing::run_program;

/// The command line is refused before anything is done.
void refused_at_once(const std::string& command, const std::vector<std::string>& fragments) {
  const auto result = run_program(command);
  EXPECT_GE(result.status, 100) << command << "\n" << result.err;
  EXPECT_LT(result.status, 124) << command << "\n" << result.err;
  for (const std::string& fragment : fragments)
    EXPECT_NE(result.err.find(fragment), std::string::npos) << command << "\n" << result.err;
}

class ToolsOutputFile : public ::testing::Test {
 protected:
  ToolsOutputFile() { scene_.write("log", "not a log"); }
  std::string file(const std::string& name) const { return scene_.folder() / name; }
  std::string run(const std::string& option, const std::string& to) const {
    return program("palpate") + " run " + scene_.scene() + " " + option + " " + to;
  }

  LoopbackScene scene_{"output-file"};
};

TEST_F(ToolsOutputFile, ADeviceIsNotReplaced) {
  for (const char* option : {"--film", "--still", "--record", "--summary"})
    refused_at_once(run(option, "/dev/null"), {option, "/dev/null is no regular file"});
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(ToolsOutputFile, ALinkIsNotFollowedNorReplaced) {
  scene_.write("precious.png", "precious");
  fs::create_symlink("precious.png", file("link.png"));
  refused_at_once(run("--still", file("link.png")), {"link.png is a link"});
  EXPECT_TRUE(fs::is_symlink(file("link.png")));
  fs::create_symlink("nowhere.png", file("dangling.png"));
  refused_at_once(run("--still", file("dangling.png")), {"dangling.png is a link"});
}

TEST_F(ToolsOutputFile, AFullDeviceForWhatIsPrintedIsNoticed) {
  EXPECT_EQ(testing::run_command("( " + program("palpate") + " check " + scene_.scene() + " > /dev/full )"), 1);
}

TEST_F(ToolsOutputFile, AFolderIsNoFile) {
  refused_at_once(run("--record", scene_.folder()), {"is a folder"});
}

TEST_F(ToolsOutputFile, AnInputIsNotWrittenOver) {
  refused_at_once(program("palpate") + " export " + file("log") + " --topic tool_state -o " + file("log"),
                  {"log is named by"});
  refused_at_once(program("palpate") + " export " + file("log") + " --topic tool_state -o " + file("../") +
                      scene_.folder().filename().string() + "/log",
                  {"log is named by"});
  refused_at_once(run("--record", scene_.scene()), {"is named by"});
}

TEST_F(ToolsOutputFile, WhatEndsInAnotherWayIsSomethingElse) {
  refused_at_once(run("--summary", scene_.scene()), {"does not end in .json"});
  refused_at_once(run("--still", file("organ.msh")), {"does not end in .png"});
  refused_at_once(run("--film", file("film.avi")), {"does not end in .mp4"});
}

}  // namespace
}  // namespace palpate
