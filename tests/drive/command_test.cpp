#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using nlohmann::json;
using testing::expect_refusal;
using testing::LoopbackScene;
using testing::program;
using testing::run_program;
using testing::text_of;

class DriveCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { scene_ = std::make_unique<LoopbackScene>("drive", testing::kLinear); }
  static void TearDownTestSuite() { scene_.reset(); }

  static std::string drive(const std::string& more) {
    return program("palpate") + " drive " + scene_->scene() + " " + more;
  }
  static std::filesystem::path file(const std::string& name) { return scene_->folder() / name; }

  static std::unique_ptr<LoopbackScene> scene_;
};
std::unique_ptr<LoopbackScene> DriveCommand::scene_;

/// A table without what every run measures anew.
std::string without_times(const std::string& table) {
  std::string heading = table.substr(0, table.find('\n'));
  const auto columns = std::count(heading.begin(), heading.begin() + heading.find(",wall"), ',') + 1;
  const std::regex times(fmt::format("^((?:[^,\n]*,){{{}}})[^,\n]*,[^,\n]*,", columns), std::regex::multiline);
  return std::regex_replace(table, times, "$1");
}

TEST_F(DriveCommand, SaysWhatARunComesToAndFailsWhereItIsNotAsExpected) {
  const auto good = run_program(drive("--json --expect \"tool.force.max>0.05\" --expect finite==1"));
  ASSERT_EQ(good.status, 0) << good.err;
  const json result = json::parse(good.out);
  EXPECT_EQ(result["outcome"], "ok");
  EXPECT_NEAR(result["figures"]["seconds"].get<double>(), 2.2, 0.002) << "until its motion is over";
  const double force = result["figures"]["tool.probe.force.max"];
  EXPECT_GT(result["figures"]["realtime_factor"].get<double>(), 1);

  expect_refusal(drive("--expect \"tool.force.max<0.01\""),
                 {fmt::format("tool.probe.force.max is {:.6g} N, expected <0.01", force)});
  const auto stiffer = run_program(drive("--json --set body.young=10000"));
  EXPECT_NEAR(json::parse(stiffer.out)["figures"]["tool.probe.force.max"].get<double>(), 2 * force, 1e-6 * force);
  const auto part = run_program(drive("--json --seconds 0.75"));
  EXPECT_NEAR(json::parse(part.out)["figures"]["seconds"].get<double>(), 0.75, 1e-9);
}

TEST(DriveBeforeAll, WhatIsWrongWithAMotionIsSaidBeforeArchivesAreComputed) {
  const LoopbackScene scene("drive-motion", testing::kLinear);
  const auto refused_at_once = [&](const std::string& command, const std::string& why) {
    expect_refusal(program("palpate") + " " + command, {why});
    EXPECT_FALSE(std::filesystem::exists(scene.folder() / ".palpate")) << command;
  };
  const std::string drive = "drive " + scene.scene();
  refused_at_once(drive + " --set tool.device=bus", "is moved by a driver elsewhere");
  scene.write("motion.csv", "time,depth\n0,0\n");
  for (const std::string& command :
       {drive, drive + " --sweep body.young=4000,8000", "run " + scene.scene() + " --domain 140"})
    refused_at_once(command, "motion.csv:1: the header must be");
}

TEST_F(DriveCommand, SweepsIntoOneTableAndTasksMergeIntoTheSame) {
  const std::string what = "--sweep body.young=4000,8000 --sweep contact.friction=0,0.5 --seconds 1.2 ";
  const auto sweep = run_program(drive(what + "-o " + file("sweep.csv").string()));
  ASSERT_EQ(sweep.status, 0) << sweep.err;
  const auto tasks = run_program(drive(what + "--tasks -o " + file("tasks.sh").string()));
  ASSERT_EQ(tasks.status, 0) << tasks.err;
  std::string out;
  ASSERT_EQ(testing::run_command(
                fmt::format("tac {} | sh >{}", file("tasks.sh").string(), file("results.jsonl").string()), &out),
            0)
      << out;
  const auto merged = run_program(fmt::format("{} drive --merge {} -o {}", program("palpate"),
                                              file("results.jsonl").string(), file("merged.csv").string()));
  ASSERT_EQ(merged.status, 0) << merged.err;

  const std::string table = text_of(file("sweep.csv"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5) << table;
  EXPECT_EQ(table.find("point,body.young,contact.friction,outcome,seconds,"), 0u) << table;
  EXPECT_NE(table.find("\n3,8000,0.5,ok,1.2,1,"), std::string::npos) << table;
  EXPECT_EQ(without_times(table), without_times(text_of(file("merged.csv"))));
}

TEST_F(DriveCommand, AMergeHoldsItsRowsToWhatIsExpectedAndNamesWhatIsMissing) {
  const std::string tasks = file("few.sh"), results = file("few.jsonl");
  ASSERT_EQ(run_program(drive("--sweep body.young=4000,5000,50000 --seconds 1.1 --tasks -o " + tasks)).status, 0);
  std::string out;
  ASSERT_EQ(testing::run_command(fmt::format("sh {} >{}", tasks, results), &out), 0) << out;
  const std::string merge = program("palpate") + " drive --merge " + results;

  const auto held = run_program(merge + " --expect \"tool.force.max<0.5\"");
  EXPECT_EQ(held.status, 1);
  EXPECT_NE(held.err.find("1 of 3 points are not as expected, such as point 2: tool.probe.force.max is"),
            std::string::npos)
      << held.err;
  EXPECT_NE(held.out.find("\n2,50000,unexpected,"), std::string::npos) << held.out;
  expect_refusal(merge + " --expect nonsense", {"--expect", "such as"});
  expect_refusal(merge + " --expect \"tool.force.mex<1\"", {"did you mean", "tool.force.max"});

  ASSERT_EQ(testing::run_command(fmt::format("sed -i -e 2d -e 1p {}", results), &out), 0) << out;
  const auto lacking = run_program(merge);
  EXPECT_EQ(lacking.status, 1);
  EXPECT_NE(lacking.err.find("point 0 has two results, which are equal: one is kept"), std::string::npos)
      << lacking.err;
  EXPECT_NE(lacking.err.find("1 of 3 points are missing: 1"), std::string::npos) << lacking.err;
  EXPECT_EQ(std::count(lacking.out.begin(), lacking.out.end(), '\n'), 3) << lacking.out;
}

TEST_F(DriveCommand, AMergeRefusesWhatIsOfARun) {
  std::ofstream(file("one.jsonl")) << run_program(drive("--seconds 0.1 --json")).out;
  const std::string merge = " --merge " + file("one.jsonl").string();
  EXPECT_EQ(run_program(program("palpate") + " drive" + merge).status, 0);
  expect_refusal(drive(merge), {"--merge", "leave SCENE out"});
  for (const std::string more : {"--seconds 1", "--set body.young=1", "--sweep body.young=1,2", "--course x.csv",
                                 "--log x.lcmlog", "--tasks", "--jobs 2"})
    expect_refusal(program("palpate") + " drive " + more + merge,
                   {"--merge", "leave " + more.substr(0, more.find(' ')) + " out"});
}

TEST_F(DriveCommand, ASweepWithAPointThatIsNotAsExpectedFailsAndKeepsItsTable) {
  const auto sweep =
      run_program(drive("--sweep body.young=5000,50000 --seconds 1.1 --expect \"tool.force.max<0.5\" --csv"));
  EXPECT_EQ(sweep.status, 1);
  EXPECT_NE(sweep.err.find("1 of 2 points are not as expected, such as point 1: tool.probe.force.max is"),
            std::string::npos)
      << sweep.err;
  EXPECT_NE(sweep.out.find("\n1,50000,unexpected,"), std::string::npos) << sweep.out;
}

TEST_F(DriveCommand, WritesTheCourseOfTheTools) {
  const auto run = run_program(drive("--seconds 1 --course " + file("course.csv").string()));
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string course = text_of(file("course.csv"));
  EXPECT_EQ(course.find("time,probe.x,probe.y,probe.z,probe.fx,probe.fy,probe.fz,probe.grip\n0,"), 0u);
  EXPECT_EQ(std::count(course.begin(), course.end(), '\n'), 1001);
}

TEST_F(DriveCommand, WritesALogThatReadsAsOneOfTheNodes) {
  const std::string log = file("run.lcmlog");
  ASSERT_EQ(run_program(drive("--log " + log)).status, 0);
  const auto verified = run_program(program("palpate") + " replay --verify " + log);
  EXPECT_EQ(verified.status, 0) << verified.err;
  EXPECT_NE(verified.out.find("verified: 2201 forces of 2201 steps"), std::string::npos) << verified.out;
  const json info = json::parse(run_program(program("palpate") + " info --json " + log).out);
  EXPECT_EQ(info["title"], "loopback block");
  EXPECT_TRUE(info["complete"].get<bool>());
  EXPECT_EQ(info["topics"]["palpate/force_state"]["samples"], 2201);
  EXPECT_NEAR(info["topics"]["palpate/force_state"]["rate_hz"].get<double>(), 1000, 1);
  EXPECT_NEAR(info["topics"]["palpate/surface_state"]["rate_hz"].get<double>(), 60, 3);
  EXPECT_EQ(info["topics"]["palpate/force_state"]["missing"], 0);
}

TEST_F(DriveCommand, WithoutAToolRunsForAsLongAsItIsTold) {
  const auto run = run_program(drive("--set tool=[] --seconds 0.2 --json"));
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NEAR(json::parse(run.out)["figures"]["seconds"].get<double>(), 0.2, 1e-9) << run.out;
}

TEST_F(DriveCommand, RefusesInWordsWhatItCannotDo) {
  expect_refusal(program("palpate") + " drive", {"give a scene"});
  expect_refusal(drive("--set body.young=-1"),
                 {"--set body.young=-1: young must be greater than 0 and at most 1e+20, and is -1"});
  expect_refusal(drive("--set body.yung=1"), {"--set body.yung=1: unknown key", "did you mean"});
  expect_refusal(drive("--expect nonsense"), {"--expect", "such as"});
  expect_refusal(drive("--expect \"tool.probe.force.mex<1\""), {"did you mean", "tool.probe.force.max"});
  expect_refusal(drive("--sweep body.young=1000,-1"), {"--set body.young=-1: "});
  expect_refusal(drive("--sweep body.young=1000,2000 --log x.lcmlog"), {"of one run"});
  expect_refusal(drive("--log /nowhere/x.lcmlog"), {"/nowhere/x.lcmlog", "cannot be written"});
  const std::string text = text_of(scene_->scene());
  scene_->write("driven.toml",
                testing::replaced(text.substr(0, text.find("device =")), "[[tool]]", "[[tool]]\ndevice = \"bus\""));
  expect_refusal(program("palpate") + " drive " + file("driven.toml").string(), {"tool 'probe'", "driver elsewhere"});
  expect_refusal(drive("--set tool=[]"), {"no tool whose motion ends the run", "--seconds"});
  const auto none = run_program(drive("--seconds 0"));
  EXPECT_NE(none.status, 0);
  EXPECT_NE(none.err.find("--seconds: give a finite number above 0, not 0"), std::string::npos) << none.err;
}

TEST(PalpateHelp, IsPrintedWithoutACommandAndNamesAllOfThem) {
  const auto bare = run_program(program("palpate")), asked = run_program(program("palpate") + " help");
  for (const auto& help : {bare, asked}) {
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(help.err, "");
    for (const char* command : {"check", "run", "drive", "replay"})
      EXPECT_NE(help.out.find(std::string("\n  ") + command + " "), std::string::npos) << help.out;
  }
  const auto drive = run_program(program("palpate") + " help drive");
  EXPECT_EQ(drive.status, 0);
  EXPECT_EQ(drive.out, run_program(program("palpate") + " drive --help").out);
  EXPECT_NE(drive.out.find("Examples:"), std::string::npos);
  const auto unknown = run_program(program("palpate") + " drvie");
  EXPECT_EQ(unknown.status, 1);
  EXPECT_EQ(unknown.err, "there is no command \'drvie\'; `palpate help` names all\n");
}

}  // namespace
}  // namespace palpate
