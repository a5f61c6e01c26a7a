// What `palpate run` starts, says and fails on.
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "common/bus/dds_bus.hpp"
#include "common/realtime/clock.hpp"
#include "tests/bus/domain.hpp"
#include "tests/tools/comes_within.hpp"
#include "tests/tools/session.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using nlohmann::json;
using namespace testing;

/// Names in a list of JSON.
std::set<std::string> names_in(const json& list) {
  std::set<std::string> names;
  for (const json& name : list) names.insert(name.get<std::string>());
  return names;
}

TEST(ToolsRun, CheckNamesTheNodesThatRunStartsAndCountsTheirMemoryAlone) {
  const LoopbackScene scene("planned", kLinear);
  const std::string text = text_of(scene.scene());
  const std::string bare = text.substr(0, text.find("[render]"));
  for (const std::string& variant : {text, bare, bare + "[record]\nfile = \"log.lcmlog\"\n"}) {
    scene.write("scene.toml", variant);
    const json check = json::parse(run_program(program("palpate") + " check --json " + scene.scene()).out);
    const std::set<std::string> told = names_in(check["nodes"]);
    for (const json& part : check["bodies"][0]["memory"])
      EXPECT_TRUE(part["owner"] == "disk" || told.contains(part["owner"].get<std::string>())) << part;

    const auto run = run_program(fmt::format("{} run {} --domain {} --seconds 0.3 --json", program("palpate"),
                                             scene.scene(), testing::own_domain()));
    ASSERT_EQ(run.status, 0) << run.err;
    const json ended = json::parse(run.out);
    std::set<std::string> started;
    for (const char* node : {"recorder", "deform_node", "render_node", "web_node", "haptic_node"})
      if (ended.contains(node)) started.insert(node);
    if (started.erase("render_node") > 0) started.insert("render_node --deform");
    EXPECT_EQ(told, started);
  }
}

TEST(ToolsRun, AKeyInPlaceOfTheFilesIsThatOfEveryNode) {
  const LoopbackScene scene("set", kLinear);
  const fs::path log = scene.folder() / "set.lcmlog";
  const auto run =
      run_program(fmt::format("{} run {} --set body.young=12345 --domain {} --seconds 0.3 --record {} "
                              "--processes 3 --summary {}",
                              program("palpate"), scene.scene(), testing::own_domain(), log.string(),
                              (scene.folder() / "summary.json").string()));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(text_of(log).find("young = 12345"), std::string::npos);
  const json summary = json::parse(text_of(scene.folder() / "summary.json"));
  EXPECT_GT(summary["deform_node"]["frames"], 0) << "it is of the same scene";
}

TEST(ToolsRun, WhatCannotBeKeptIsSaidBeforeTheRun) {
  const LoopbackScene scene("unkept", kLinear);
  const std::string text = text_of(scene.scene());
  scene.write("scene.toml", text.substr(0, text.find("[render]")));
  const std::string begin =
      fmt::format("{} run {} --domain {} --seconds 30", program("palpate"), scene.scene(), testing::own_domain());
  const auto without_log = run_program(begin + " --keep enough");
  EXPECT_NE(without_log.status, 0);
  EXPECT_NE(without_log.err.find("--keep: there is no log"), std::string::npos) << without_log.err;
  const auto below_a_file = run_program(begin + " --summary " + scene.scene() + "/summary.json");
  EXPECT_NE(below_a_file.status, 0);
  EXPECT_EQ(below_a_file.out.find("haptic"), std::string::npos) << below_a_file.out;
}

TEST(ToolsRun, AQuietRunSaysItsResultsAlone) {
  const LoopbackScene scene("quiet", kLinear);
  const ProgramResult said = run_program(fmt::format("{} run {} --domain {} --seconds 0.3 --quiet", program("palpate"),
                                                     scene.scene(), testing::own_domain()));
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(said.err.find("haptic loop at"), std::string::npos) << said.err;
  EXPECT_TRUE(said.out.starts_with("haptic ")) << said.out;
}

TEST(ToolsRun, ASceneWithoutAToolIsForLockStep) {
  const LoopbackScene scene("toolless", kLinear);
  expect_refusal(program("palpate") + " run " + scene.scene() + " --set tool=[]",
                 {"has no tool", "drive", "--seconds"});
}

TEST(ToolsRunSound, EndsWithoutAnAlarmAndPassesAsStrict) {
  const LoopbackScene scene("calm", kLinear);
  scene.write("motion.csv", kSlowPress);
  for (const int processes : {2, 3}) {
    const auto run = run_program(fmt::format("{} run {} --domain {} --processes {} --seconds 3.6 --strict",
                                             program("palpate"), scene.scene(), testing::own_domain(), processes));
    EXPECT_EQ(run.status, 0) << run.err;
    for (const char* alarm : {"gone", "lost", "network is cut", "guarded", "refus"})
      EXPECT_EQ(run.err.find(alarm), std::string::npos) << run.err;
  }
}

TEST(ToolsRun, AStrictRunFailsWhereTheHandHadToBeGuarded) {
  const LoopbackScene scene("strict", kLinear);
  scene.write("motion.csv",
              "time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n0.5,0,0,0.17,0,0\n0.501,0,0,0.1,0,0\n1,0,0,0.1,0,0\n");
  const std::string command =
      fmt::format("{} run {} --domain {} --seconds 0.8", program("palpate"), scene.scene(), testing::own_domain());
  const auto run = run_program(command), strict = run_program(command + " --strict");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find("the hand was guarded: "), std::string::npos) << run.err;
  EXPECT_EQ(strict.status, 1);
  EXPECT_NE(strict.err.find("palpate: the hand was guarded: "), std::string::npos) << strict.err;
}

/// A haptic node that runs beside a render node, which says when it is gone.
class ToolsRunBeside : public ::testing::Test {
 protected:
  void SetUp() override {
    scene_.write("motion.csv", "time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n1,0,0,0.198,0,0\n900,0,0,0.199,0,0\n");
    ASSERT_EQ(run_program(program("palpate") + " precompute " + scene_.scene()).status, 0);
    render_ = std::make_unique<ChildProcess>(node("render_node", "--deform 2>" + said_.string()));
    haptic_ = std::make_unique<ChildProcess>(node("haptic_node", "2>/dev/null"));
    ASSERT_TRUE(comes_within(20s, [&] { return text_of(said_).find("met haptic") != std::string::npos; }));
  }

  ChildProcess node(const std::string& name, const std::string& more) const {
    return {name,
            {"/bin/sh", "-c",
             fmt::format("exec {} {} --domain {} {}", program(name), scene_.scene(), testing::own_domain(), more)}};
  }
  int times_gone() const {
    const std::string text = text_of(said_);
    int times = 0;
    for (std::size_t at = text.find("node is gone"); at != text.npos; at = text.find("node is gone", at + 1)) ++times;
    return times;
  }

  LoopbackScene scene_{"standing", kLinear};
  fs::path said_ = scene_.folder() / "said";
  std::unique_ptr<ChildProcess> render_, haptic_;
};

TEST_F(ToolsRunBeside, TheHapticNodeIsGoneOnlyWhenItIs) {
  std::this_thread::sleep_for(3s);
  for (int stop = 0; stop < 3; ++stop) {
    kill(haptic_->pid(), SIGSTOP);
    std::this_thread::sleep_for(300ms);
    kill(haptic_->pid(), SIGCONT);
    std::this_thread::sleep_for(500ms);
  }
  EXPECT_EQ(times_gone(), 0) << text_of(said_);
  kill(haptic_->pid(), SIGKILL);
  EXPECT_TRUE(comes_within(10s, [&] { return times_gone() > 0; })) << text_of(said_);
  std::this_thread::sleep_for(1s);
  EXPECT_EQ(times_gone(), 1) << text_of(said_);
}

// For ten minutes with PALPATE_LONG_TESTS.
TEST_F(ToolsRunBeside, TheHapticNodeIsNotGoneWhereTheMachineIsBusy) {
  std::vector<std::unique_ptr<ChildProcess>> busy;
  for (unsigned i = 0; i < 2 * std::thread::hardware_concurrency(); ++i)
    busy.push_back(
        std::make_unique<ChildProcess>("busy", std::vector<std::string>{"/bin/sh", "-c", "while :; do :; done"}));
  const std::chrono::seconds time = std::getenv("PALPATE_LONG_TESTS") ? 600s : 5s;
  EXPECT_FALSE(comes_within(time, [&] { return times_gone() > 0 || !haptic_->running(); })) << text_of(said_);
}

TEST(ToolsRun, ADriverThatNeverSpeaksIsWaitedForAsLongAsTheRunIsToLast) {
  const LoopbackScene scene("no-driver", kLinear);
  scene.replace("device = \"scripted\"\ntrajectory = \"motion.csv\"", "device = \"bus\"");
  ASSERT_EQ(run_program(program("palpate") + " precompute " + scene.scene()).status, 0);
  const auto haptic = run_program(
      fmt::format("{} {} --domain {} --seconds 1", program("haptic_node"), scene.scene(), testing::own_domain()));
  EXPECT_EQ(haptic.status, 1);
  EXPECT_NE(haptic.err.find("no driver on topic palpate/device_state has spoken for 1 s"), std::string::npos)
      << haptic.err;
}

TEST(ToolsRun, ADriverInOtherUnitsIsToldSo) {
  const LoopbackScene scene("mm-driver", kLinear);
  scene.replace("device = \"scripted\"\ntrajectory = \"motion.csv\"", "device = \"bus\"");
  ASSERT_EQ(run_program(program("palpate") + " precompute " + scene.scene()).status, 0);
  const auto bus = make_dds_bus({.domain = testing::own_domain(), .role = "driver"});
  const auto writer = bus->writer(topics::device_state);
  std::atomic<bool> ended = false;
  std::thread driver([&] {
    DeviceState state;
    state.depth = 185;  // mm
    for (; !ended; std::this_thread::sleep_for(5ms)) {
      ++state.seq;
      state.sense_ns = now_ns();
      writer->write(state);
    }
  });
  const auto haptic = run_program(
      fmt::format("{} {} --domain {} --seconds 2", program("haptic_node"), scene.scene(), testing::own_domain()));
  ended = true;
  driver.join();
  EXPECT_EQ(haptic.status, 1);
  EXPECT_NE(haptic.err.find("puts tool 0 where no tool can be, at yaw 0, pitch 0, depth 185"), std::string::npos)
      << haptic.err;
  EXPECT_NE(haptic.err.find(" samples were not heard"), std::string::npos) << haptic.err;
}

TEST(ToolsRun, ASceneTellsTheNetworkToCommandsThatJoinIt) {
  const LoopbackScene scene("network", kLinear);
  const int domain = testing::own_domain();
  scene.replace("[render]\n", fmt::format("[network]\ndomain = {}\n[render]\n", domain));
  const std::string log = scene.folder() / "a.lcmlog",
                    record = program("palpate") + " record --seconds 0.3 --force -o ";
  const auto recorded = run_program(record + log + " --scene " + scene.scene());
  EXPECT_EQ(recorded.status, 0) << recorded.err;
  EXPECT_NE(recorded.out.find(fmt::format("recording domain {} to", domain)), std::string::npos) << recorded.out;
  const auto named = run_program(record + log + " --domain 120 --scene " + scene.scene());
  EXPECT_NE(named.out.find("recording domain 120 to"), std::string::npos) << named.out;
  const auto played = run_program(program("palpate") + " replay --json " + log + " --scene " + scene.scene());
  EXPECT_EQ(played.status, 0) << played.err;
  const auto top = run_program(program("palpate") + " top --once --json --scene " + scene.scene());
  EXPECT_EQ(json::parse(top.out)["domain"], domain);
  const json as_json = json::parse(run_program(record + log + " --json --scene " + scene.scene()).out);
  EXPECT_EQ(as_json["file"], log);
  EXPECT_EQ(as_json["scene"], false);
}

}  // namespace
}  // namespace palpate
