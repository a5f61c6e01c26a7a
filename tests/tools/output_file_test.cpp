#include <gtest/gtest.h>

#include "tests/bus/domain.hpp"
#include "tests/tools/program_result.hpp"

/// What a command writes never takes the place of what is not its own.
namespace palpate {
namespace {

namespace fs = std::filesystem;
using testing::LoopbackScene;
using testing::program;
using testing::run_program;
using testing::text_of;

/// The command line is refused before anything is done.
void refused_at_once(const std::string& command, const std::vector<std::string>& fragments) {
  const auto result = run_program(command);
  EXPECT_EQ(result.status, 1) << command << "\n" << result.err;
  EXPECT_NE(result.err.find("Run with --help"), std::string::npos) << command << "\n" << result.err;
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

  std::string drive(const std::string& option, const std::string& to) const {
    return program("palpate") + " drive " + scene_.scene() + " --seconds 0.05 " + option + " " + to;
  }

  LoopbackScene scene_{"output-file", testing::kLinear};
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

TEST_F(ToolsOutputFile, APipeWhoseReaderHasGoneEndsInOrder) {
  const auto into_nothing = [](const std::string& command) {
    return testing::run_command("timeout 60 bash -c '" + command + " 2>&1 | true; exit ${PIPESTATUS[0]}'");
  };
  EXPECT_EQ(into_nothing(drive("--json", "")), 1);
  EXPECT_EQ(
      into_nothing(program("palpate") + fmt::format(" top --json --interval 0.1 --domain {}", testing::own_domain())),
      1);
}

TEST_F(ToolsOutputFile, AFolderIsNoFile) {
  refused_at_once(run("--record", scene_.folder()), {"is a folder"});
}

TEST_F(ToolsOutputFile, AFolderThatIsNotThereIsNamedBeforeTheRun) {
  for (const char* option : {"--record", "--film", "--summary"}) {
    const std::string ending = option[2] == 'r' ? ".lcmlog" : option[2] == 'f' ? ".mp4" : ".json";
    testing::expect_refusal(run(option, file("none/a") + ending),
                            {"none/a" + ending + ": it cannot be written, since the folder ", "/none is not there"});
  }
}

TEST_F(ToolsOutputFile, AnInputIsNotWrittenOver) {
  refused_at_once(program("palpate") + " export " + file("log") + " --topic tool_state -o " + file("log"),
                  {"log is named by"});
  refused_at_once(program("palpate") + " export " + file("log") + " --topic tool_state -o " + file("../") +
                      scene_.folder().filename().string() + "/log",
                  {"log is named by"});
  refused_at_once(run("--record", scene_.scene()), {"is named by"});
}

TEST_F(ToolsOutputFile, TwoOutputsAreNotOneFileUnderTwoNames) {
  refused_at_once(drive("-o " + file("new.csv") + " --course", file("./new.csv")), {"new.csv is named by"});
}

TEST_F(ToolsOutputFile, ALinkUnderAForeseeableNameIsNotWrittenThrough) {
  scene_.write("victim", "precious");
  fs::create_symlink("victim", file("x.lcmlog.part"));
  const auto run = run_program(drive("--log", file("x.lcmlog")));
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(text_of(file("victim")), "precious");
  EXPECT_TRUE(fs::is_symlink(file("x.lcmlog.part")));
  EXPECT_GT(fs::file_size(file("x.lcmlog")), 1000u);
}

TEST_F(ToolsOutputFile, WhatTheSceneNamesIsKept) {
  const std::string mesh = text_of(file("block.msh")), motion = text_of(file("motion.csv"));
  const std::string palpate = program("palpate") + " ";
  for (const std::string& command :
       {run("--record", file("block.msh")) + " --force", drive("--log", file("block.msh")) + " --force",
        drive("--course", file("motion.csv")) + " --force",
        palpate + "motion " + scene_.scene() + " \"press 1mm\" -o " + file("motion.csv"),
        drive("--log", file("../" + scene_.folder().filename().string() + "/block.msh")) + " --force"})
    testing::expect_refusal(command, {"needs this file"});
  refused_at_once(palpate + "solve " + scene_.scene() + " --force 0:0,0,-0.001 --csv " + file("motion.csv"),
                  {"is a trajectory"});
  EXPECT_EQ(text_of(file("block.msh")), mesh);
  EXPECT_EQ(text_of(file("motion.csv")), motion);
}

/// A folder's files are a command's own where the one that it writes first is.
TEST_F(ToolsOutputFile, InAFolderNothingIsReplacedThatTheCommandDidNotMake) {
  ASSERT_EQ(run_program(drive("--log", file("run.lcmlog"))).status, 0);
  const std::string out = scene_.folder() / "report/", latency = scene_.folder() / "latency/";
  const std::string report =
      program("palpate") + " report --pictures 1 " + file("run.lcmlog") + " " + file("run.lcmlog") + " -o " + out;
  const std::string measure = program("palpate") + fmt::format(" latency --seconds 0.1 --domain {} --udp-port {} -o {}",
                                                               testing::own_domain(), testing::own_udp_port(), latency);
  fs::create_directory(out);
  fs::create_directory(latency);
  const auto kept = [&](const std::string& command, const std::string& name, const std::string& text) {
    std::ofstream(name) << text;
    testing::expect_refusal(command, {name + ": not made by this command"});
    EXPECT_EQ(text_of(name), text);
    fs::remove(name);
  };
  for (const char* name :
       {"course_0.csv", "course_1.csv", "index.html", "report.json", "picture_0_0.png", "picture_1_0.png"})
    kept(report, out + name, "precious");
  EXPECT_TRUE(fs::is_empty(out));
  kept(measure, latency + "latency.json", "{\n  \"precious\": 1\n}\n");
  kept(measure, latency + "latency.png", "precious");
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(run_program(report).status, 0) << "its own are written anew";
    EXPECT_EQ(run_program(measure).status, 0);
  }
}

TEST_F(ToolsOutputFile, AFileOfAnotherKindIsReplacedOnlyByForce) {
  scene_.write("notes", "of the kidney, and of the spleen\n");
  scene_.write("other.png", "no picture");
  refused_at_once(drive("--log", file("notes")), {"notes is text, and would be replaced by a topic log", "--force"});
  refused_at_once(run("--still", file("other.png")), {"other.png is text", "a picture"});
  refused_at_once(drive("--json -o", scene_.scene()), {"is named by"});
  EXPECT_EQ(text_of(file("notes")), "of the kidney, and of the spleen\n");
  EXPECT_EQ(run_program(drive("--log", file("notes")) + " --force").status, 0);
  EXPECT_EQ(run_program(drive("--log", file("notes"))).status, 0) << "a log replaces a log";
  for (int round = 0; round < 2; ++round) EXPECT_EQ(run_program(drive("--course", file("course.csv"))).status, 0);
}

TEST_F(ToolsOutputFile, WhatEndsInAnotherWayIsSomethingElse) {
  refused_at_once(run("--summary", scene_.scene()), {"does not end in .json"});
  refused_at_once(run("--still", file("organ.msh")), {"does not end in .png"});
  refused_at_once(run("--film", file("film.avi")), {"does not end in .mp4"});
}

}  // namespace
}  // namespace palpate
