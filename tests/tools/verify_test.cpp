#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "common/bus/dds_bus.hpp"
#include "common/bus/log_reader.hpp"
#include "common/bus/log_writer.hpp"
#include "idl/topics.hpp"
#include "tests/bus/domain.hpp"
#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using testing::LoopbackScene;
using testing::program;
using testing::ProgramResult;
using testing::run_program;

/// Copies a log event by event with right checksums; `change` may alter each on its way.
void rewrite(
    const fs::path& from, const fs::path& to, const std::function<void(LogEvent&)>& change,
    const std::function<void(LogHeader&)>& change_header = [](LogHeader&) {}) {
  LogReader reader(from);
  LogWriter writer(to, std::size_t{1} << 30);
  LogHeader header = reader.header();
  change_header(header);
  writer.write(kHeaderChannel, header.start_monotonic_ns, header);
  for (LogEvent event; reader.next(event);) {
    change(event);
    writer.write_payload(event.channel, event.receive_ns, event.payload);
  }
  EXPECT_EQ(writer.finish().lost, 0u);
}

template <class M>
void put_back(LogEvent& event, const M& message) {
  event.payload.clear();
  encode(message, event.payload);
}

/// A recorded session of the haptic node, of which each test makes a changed copy.
class ToolsVerify : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<LoopbackScene>("verify", testing::kLinear);
    const auto run = run_program(fmt::format("{} run {} --seconds 2.3 --domain {} --record {}", program("palpate"),
                                             scene_->scene(), testing::own_domain(), log().string()));
    ASSERT_EQ(run.status, 0) << run.err;
  }
  static void TearDownTestSuite() { scene_.reset(); }
  void SetUp() override { fs::remove(changed()); }

  static fs::path log() { return scene_->folder() / "session.lcmlog"; }
  static fs::path changed() { return scene_->folder() / "changed.lcmlog"; }
  static ProgramResult verify(const fs::path& file) {
    return run_program(program("palpate") + " replay " + file.string() + " --verify");
  }

  static std::unique_ptr<LoopbackScene> scene_;
};
std::unique_ptr<LoopbackScene> ToolsVerify::scene_;

/// Samples of a topic in a log, from where it goes without what can be computed again.
int samples_of(const fs::path& file, const std::string& topic) {
  LogReader reader(file);
  int count = 0;
  for (LogEvent event; reader.next(event);) count += reader.thinned_steps() > 0 && event.channel == topic;
  return count;
}

TEST_F(ToolsVerify, ALogThatIsPlayedByTheNetworkOfAnotherSceneSaysSo) {
  const LoopbackScene other("verify-other", testing::kLinear, 9000);
  const std::string play = fmt::format("{} replay {} --speed 100 --domain {} --scene ", program("palpate"),
                                       log().string(), testing::own_domain());
  const std::string words = "is of another scene than";
  EXPECT_EQ(run_program(play + scene_->scene()).err.find(words), std::string::npos);
  EXPECT_NE(run_program(play + other.scene()).err.find(words), std::string::npos);
  EXPECT_NE(run_program(program("palpate") + " replay --verify " + log().string() + " --scene " + other.scene()).status,
            0)
      << "a log is verified with its own scene";
}

TEST_F(ToolsVerify, AReplayDoesNotSpeakForNodesThatLiveNorMoveTheMotorsOfADriver) {
  const std::string play =
      fmt::format("{} replay {} --speed 100 --domain {}", program("palpate"), log().string(), testing::own_domain());
  const auto bus = make_dds_bus({.domain = testing::own_domain(), .role = "haptic"});
  {
    const auto driver = bus->writer(topics::device_state);
    testing::expect_refusal(play, {"a driver of a device is in ", "its motors would give the forces of the log"});
    EXPECT_EQ(run_program(play + " --topic tool_state").status, 0);
    NodeStatus page;
    page.node = "web 8@here";
    page.role = "web";
    const auto pages = bus->writer(topics::node_status);
    ASSERT_TRUE(pages->write(page));
    const auto shown = run_program(play);
    EXPECT_EQ(shown.status, 0) << "a page has no motors: " << shown.err;
  }
  NodeStatus status;
  status.node = "haptic 7@here";
  status.role = "haptic";
  const auto nodes = bus->writer(topics::node_status);
  ASSERT_TRUE(nodes->write(status));
  testing::expect_refusal(play, {"haptic 7@here lives in domain", "--domain"});
  EXPECT_EQ(run_program(play + " --topic node_status").status, 0) << "not of these nodes alone";
}

TEST_F(ToolsVerify, ALogOfTwoScenesIsRefusedByWhatNeedsOne) {
  {
    LogReader reader(log());
    LogWriter writer(changed(), std::size_t{1} << 30);
    writer.write(kHeaderChannel, reader.header().start_monotonic_ns, reader.header());
    LogEvent event;
    while (reader.next(event)) writer.write_payload(event.channel, event.receive_ns, event.payload);
    SceneText other;
    other.scene_hash = "00000000000000000000000000000001";
    other.text = "title = \"a plate\"\n";
    writer.write(topics::scene.name, event.receive_ns + 1, other);
    writer.finish();
  }
  const std::string film = (scene_->folder() / "two.mp4").string(), page = (scene_->folder() / "page").string();
  for (const std::string& command :
       {" replay --verify " + changed().string(), " film " + changed().string() + " -o " + film,
        " report " + changed().string() + " -o " + page}) {
    const auto refused = run_program(program("palpate") + command);
    EXPECT_EQ(refused.status, 1) << command;
    EXPECT_NE(refused.err.find("changed.lcmlog: it holds two scenes, "), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("'a plate'"), std::string::npos) << refused.err;
  }
  EXPECT_FALSE(fs::exists(film));
}

TEST_F(ToolsVerify, TwoRunsAtOnceAreToldWithTheirTimes) {
  {
    LogReader reader(log());
    LogWriter writer(changed(), std::size_t{1} << 30);
    writer.write(kHeaderChannel, reader.header().start_monotonic_ns, reader.header());
    ToolState state;
    for (LogEvent event; reader.next(event);) {
      writer.write_payload(event.channel, event.receive_ns, event.payload);
      if (!event.read(topics::tool_state, state) || state.step < 500 || state.step > 1500) continue;
      state.run = 0xAB;
      writer.write(event.channel, event.receive_ns, state);
    }
    writer.finish();
  }
  const std::string two = "changed.lcmlog: it holds two runs at once, ", palpate = program("palpate") + " ";
  const std::string film = (scene_->folder() / "two.mp4").string(), page = (scene_->folder() / "page").string();
  testing::expect_refusal(palpate + "film " + changed().string() + " -o " + film, {two, " 00000000000000ab, from "});
  testing::expect_refusal(palpate + "report " + changed().string() + " -q -o " + page, {two});
  EXPECT_NE(verify(changed()).err.find(two), std::string::npos);
  const auto exported = run_program(palpate + "export --topic tool_state " + changed().string());
  EXPECT_EQ(exported.status, 0);
  EXPECT_NE(exported.err.find(two), std::string::npos) << exported.err;
  EXPECT_NE(run_program(palpate + "info " + changed().string()).out.find("it holds two runs at once"),
            std::string::npos);
  EXPECT_EQ(run_program(palpate + "info " + log().string()).out.find("two runs"), std::string::npos);
}

TEST_F(ToolsVerify, WhatTheRecorderLostIsRepeated) {
  {
    LogReader reader(log());
    LogWriter writer(changed(), std::size_t{1} << 30);
    writer.write(kHeaderChannel, reader.header().start_monotonic_ns, reader.header());
    LogEvent event;
    while (reader.next(event)) writer.write_payload(event.channel, event.receive_ns, event.payload);
    writer.write(kFooterChannel, event.receive_ns, LogFooter{event.receive_ns, 5, 12, "no space left"});
  }
  const auto verified = verify(changed());
  EXPECT_EQ(verified.status, 0) << verified.err;
  EXPECT_NE(verified.err.find("changed.lcmlog: the recorder lost 12 messages: no space left"), std::string::npos)
      << verified.err;
  const auto json =
      nlohmann::json::parse(run_program(program("palpate") + " replay --verify --json " + changed().string()).out);
  EXPECT_EQ(json["lost"], 12);
}

TEST_F(ToolsVerify, ATopicThatTheLogHasNotIsNoReplay) {
  testing::expect_refusal(fmt::format("{} replay {} --topic modal_state --domain {}", program("palpate"),
                                      log().string(), testing::own_domain()),
                          {"holds no sample of palpate/modal_state"});
}

TEST_F(ToolsVerify, AReportWithoutForcesSaysSo) {
  rewrite(log(), changed(), [](LogEvent& event) {
    if (event.channel == topics::force_state.name) event.channel = "palpate/other";
  });
  const auto report = run_program(fmt::format("{} report {} --pictures 0 -o {}", program("palpate"), changed().string(),
                                              (scene_->folder() / "noforce").string()));
  EXPECT_EQ(report.status, 0) << report.err;
  EXPECT_NE(report.err.find("holds no sample of palpate/force_state"), std::string::npos) << report.err;
}

TEST_F(ToolsVerify, StepsBeforeTheFirstKeyframeAreToldOf) {
  bool is_first = true;
  rewrite(log(), changed(), [&](LogEvent& event) {
    if (event.channel == topics::haptic_keyframe.name && std::exchange(is_first, false))
      event.channel = "palpate/other";
  });
  const auto verified = verify(changed());
  EXPECT_EQ(verified.status, 0) << verified.err;
  EXPECT_NE(verified.out.find(" steps that were recorded before the first keyframe of their run"), std::string::npos)
      << verified.out;
  EXPECT_EQ(verify(log()).out.find("before the first keyframe"), std::string::npos);
}

TEST_F(ToolsVerify, ALogThatKeepsEnoughIsVerifiedWithoutTheRest) {
  const auto run =
      run_program(fmt::format("{} run {} --seconds 2.3 --processes 3 --domain {} --record {} --keep enough",
                              program("palpate"), scene_->scene(), testing::own_domain(), changed().string()));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto verified = verify(changed());
  EXPECT_EQ(verified.status, 0) << verified.err;
  const int steps = samples_of(changed(), topics::tool_state.name);
  EXPECT_GT(steps, 500);
  EXPECT_EQ(samples_of(changed(), topics::surface_state.name), 0) << "they follow from the contacts";
  EXPECT_NEAR(samples_of(changed(), topics::force_state.name), steps / 17.0, 1);
  EXPECT_LE(samples_of(changed(), topics::contact_state.name), steps / 17 + 1);
  const auto info = run_program(program("palpate") + " info " + changed().string());
  EXPECT_NE(info.out.find("keeps enough: one in 17 steps"), std::string::npos) << info.out;
}

TEST_F(ToolsVerify, OneBitOfOneForceFailsAndTheStepIsNamed) {
  rewrite(log(), changed(), [](LogEvent&) {});
  EXPECT_EQ(verify(changed()).status, 0) << "a log that was written anew as it was";
  const auto in_json = [&] {
    return nlohmann::json::parse(run_program(program("palpate") + " replay --verify --json " + changed().string()).out);
  };
  EXPECT_EQ(in_json()["verified"], true);
  EXPECT_GT(in_json()["forces"], 1000);

  std::uint64_t altered = 0;
  rewrite(log(), changed(), [&](LogEvent& event) {
    ForceState force;
    if (altered || !event.read(topics::force_state, force) || force.step < 1000) return;
    force.force[2] = std::bit_cast<double>(std::bit_cast<std::uint64_t>(force.force[2]) ^ 1);
    put_back(event, force);
    altered = force.step;
  });
  ASSERT_NE(altered, 0u);
  const auto result = verify(changed());
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find(fmt::format("the forces differ: step {}, tool 0", altered)), std::string::npos)
      << result.err;
  EXPECT_EQ(in_json()["verified"], false);
  EXPECT_NE(in_json()["mismatch"], "");
}

TEST_F(ToolsVerify, WhatTheRecorderDidNotHearOfTheLastStepsIsNotMissed) {
  std::uint64_t last = 0;
  LogReader reader(log());
  ToolState tool;
  for (LogEvent event; reader.next(event);)
    if (event.read(topics::tool_state, tool)) last = std::max(last, tool.step);
  const auto without = [&](std::uint64_t step) {
    rewrite(log(), changed(), [&](LogEvent& event) {
      if (event.read(topics::tool_state, tool) && tool.step == step) event.channel = "nothing";
    });
    return verify(changed());
  };
  EXPECT_EQ(without(last - 2).status, 0);
  const auto within = without(last - 100);
  EXPECT_EQ(within.status, 1);
  // Up to the end, or to the next keyframe where there is one: the sentence is another.
  EXPECT_NE(within.err.find(fmt::format("step {}", last - 100)), std::string::npos) << within.err;
  EXPECT_NE(within.err.find("is not in the log"), std::string::npos) << within.err;
}

TEST_F(ToolsVerify, ATruncatedLogIsVerifiedUpToTheDamage) {
  fs::copy_file(log(), changed());
  fs::resize_file(changed(), fs::file_size(log()) * 6 / 10 + 7);
  std::multiset<std::uint64_t> forces;
  std::set<std::uint64_t> inputs;
  LogReader reader(changed());
  ForceState force;
  ToolState tool;
  for (LogEvent event; reader.next(event);) {
    if (event.read(topics::force_state, force)) forces.insert(force.step);
    if (event.read(topics::tool_state, tool)) inputs.insert(tool.step);
  }
  // The cut may lie between a force and its input, which follows it.
  const auto forces_left = std::ranges::count_if(forces, [&](std::uint64_t step) { return inputs.contains(step); });
  ASSERT_GT(forces_left, 500);

  const auto result = verify(changed());
  const std::string said = result.out + result.err;
  EXPECT_LE(result.status, 1);
  EXPECT_NE(said.find(fmt::format("verified: {} forces", forces_left)) == std::string::npos,
            said.find(fmt::format("not verified as a whole: {} forces", forces_left)) == std::string::npos)
      << said;
  EXPECT_NE(said.find("cut off"), std::string::npos) << said;

  const auto info = run_program(program("palpate") + " info " + changed().string() + " --json");
  EXPECT_EQ(info.status, 0) << info.err;
  const auto json = nlohmann::json::parse(info.out);
  EXPECT_FALSE(json["complete"].get<bool>());
  ASSERT_EQ(json["damage"].size(), 1u);
  EXPECT_TRUE(json["damage"][0]["tail"].get<bool>());
}

TEST_F(ToolsVerify, ALogWhoseRecorderHeardTheSceneLateIsVerifiedWithTheSceneOfItsTopic) {
  rewrite(
      log(), changed(), [](LogEvent&) {},
      [](LogHeader& header) { header.scene = header.scene_hash = header.code_path = ""; });
  const auto verified = verify(changed());
  EXPECT_EQ(verified.status, 0) << verified.err;
  const auto info = run_program(program("palpate") + " info " + changed().string() + " --json");
  EXPECT_EQ(nlohmann::json::parse(info.out)["title"], "loopback block");

  rewrite(
      log(), changed(),
      [](LogEvent& event) {
        if (event.channel == topics::scene.name) event.channel = topics::node_status.name;
      },
      [](LogHeader& header) { header.scene = ""; });
  testing::expect_refusal(program("palpate") + " replay --verify " + changed().string(),
                          {"changed.lcmlog: ", "no scene"});
}

TEST_F(ToolsVerify, ALogOfAnotherCodePathIsRefusedInWords) {
  const auto with_code_path = [&](const std::function<std::string(const std::string&)>& change) {
    rewrite(log(), changed(), [&](LogEvent& event) {
      HapticKeyframe keyframe;
      if (!event.read(topics::haptic_keyframe, keyframe)) return;
      keyframe.code_path = change(keyframe.code_path);
      put_back(event, keyframe);
    });
  };
  const std::string verify_changed = program("palpate") + " replay " + changed().string() + " --verify";
  with_code_path([](const std::string& path) { return "x86-64-v9" + path.substr(path.find("; ")); });
  testing::expect_refusal(verify_changed, {"x86-64-v9", "cannot run here"});
  with_code_path([](const std::string& path) { return path.substr(0, path.find("; ")) + "; palpate 77.0 g++ 1.0"; });
  testing::expect_refusal(verify_changed, {"palpate 77.0 g++ 1.0", "differ"});
}

}  // namespace
}  // namespace palpate
