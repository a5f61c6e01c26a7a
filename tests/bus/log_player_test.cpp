#include "tools/log_player.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/bus/log_writer.hpp"
#include "common/bus/memory_bus.hpp"
#include "common/realtime/clock.hpp"
#include "tests/bus/messages_for_tests.hpp"
#include "tools/log_summary.hpp"
#include "tools/logs/log_sender.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;
namespace fs = std::filesystem;

constexpr std::int64_t kMs = 1'000'000;

/// 200 steps at 1 kHz, sensed 0.3 ms before they were received, one of them missing; and a scene.
class PlayedLog : public ::testing::Test {
 protected:
  PlayedLog() : file_(fs::temp_directory_path() / ("palpate_play_" + std::to_string(getpid()) + ".lcmlog")) {
    LogWriter writer(file_);
    LogHeader header;
    header.schema = schema_text();
    header.scene = "title = \"a plate\"\nx = 1\n";
    writer.write(kHeaderChannel, 10 * kMs, header);
    writer.write(topics::scene.name, 10 * kMs, scene_sample());
    for (std::uint64_t step = 0; step < 200; ++step) {
      if (step == 100) continue;
      const std::int64_t time = (10 + static_cast<std::int64_t>(step)) * kMs;
      ToolState tool = tool_sample(step);
      tool.sense_ns = time - 300'000;
      writer.write(topics::tool_state.name, time, tool);
    }
    writer.finish();
  }
  ~PlayedLog() override { fs::remove(file_); }

  fs::path file_;
  std::shared_ptr<MemoryNetwork> network_ = make_memory_network();
  std::unique_ptr<Bus> bus_ = make_memory_bus(network_);
};

TEST_F(PlayedLog, ComesBackInOrderAtItsOwnPace) {
  const auto tools = bus_->reader(topics::tool_state, Keep::all);
  const auto scenes = bus_->reader(topics::scene, Keep::all);
  const std::int64_t start = now_ns();
  const PlayReport report = play_log(file_, *bus_, {}, [](double) { return true; });
  EXPECT_GE(now_ns() - start, 199 * kMs);
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.played, 200u);
  EXPECT_EQ(report.skipped, 0u);
  EXPECT_NEAR(report.seconds, 0.199, 1e-9);
  EXPECT_LT(report.pace.percentile(0.5), kMs);
  SceneText scene = *scenes->take();
  EXPECT_GT(scene.publish_ns, start - 50 * kMs);  // moved to the time of the replay
  scene.publish_ns = scene_sample().publish_ns;
  EXPECT_TRUE(scene == scene_sample());
  std::int64_t last = 0;
  for (std::uint64_t step = 0; step < 200; ++step) {
    if (step == 100) continue;
    const auto tool = tools->take();
    ASSERT_TRUE(tool);
    EXPECT_EQ(tool->seq, step);
    EXPECT_GT(tool->sense_ns, start - kMs);  // moved to the time of the replay
    EXPECT_GT(tool->sense_ns, last);
    last = tool->sense_ns;
  }
}

TEST_F(PlayedLog, PlaysAtOtherSpeedsAndStopsWhenAsked) {
  const auto tools = bus_->reader(topics::tool_state, Keep::all);
  std::int64_t start = now_ns();
  play_log(file_, *bus_, {.speed = 4, .topics = {}, .patience = {}}, [](double) { return true; });
  const std::int64_t fast = now_ns() - start;
  EXPECT_GE(fast, 49 * kMs);
  EXPECT_LT(fast, 190 * kMs);

  const PlayReport stopped =
      play_log(file_, *bus_, {.speed = 1, .topics = {}, .patience = {}}, [](double) { return false; });
  EXPECT_FALSE(stopped.complete);
  EXPECT_LT(stopped.played, 5u);
  EXPECT_THROW(play_log(file_, *bus_, {.speed = 0, .topics = {}, .patience = {}}, [](double) { return true; }),
               std::runtime_error);
}

TEST_F(PlayedLog, PlaysTheChosenTopicsAlone) {
  const auto tools = bus_->reader(topics::tool_state, Keep::all);
  const PlayReport report =
      play_log(file_, *bus_, {.speed = 100, .topics = {"palpate/scene"}, .patience = {}}, [](double) { return true; });
  EXPECT_EQ(report.played, 1u);
  EXPECT_EQ(report.skipped, 199u);
  EXPECT_FALSE(tools->take());
  EXPECT_THROW(
      play_log(file_, *bus_, {.speed = 1, .topics = {"palpate/nothing"}, .patience = {}}, [](double) { return true; }),
      std::runtime_error);
}

TEST_F(PlayedLog, ATopicMayBeNamedWithoutWhoseItIs) {
  EXPECT_EQ(topics_in(file_, {"tool_state"}), topics_in(file_, {topics::tool_state.name}));
  EXPECT_EQ(topics_in(file_, {"tool_state"}).size(), 1u);
  try {
    topics_in(file_, {"tool_stat"});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("no topic 'tool_stat'; the topics are "), std::string::npos);
    EXPECT_NE(std::string(error.what()).find(" force_state"), std::string::npos) << error.what();
  }
}

TEST_F(PlayedLog, IsSummarisedWithRatesGapsAndLatencies) {
  const LogSummary summary = summarise_log(file_);
  EXPECT_EQ(summary.title, "a plate");
  EXPECT_EQ(summary.code_path, scene_sample().code_path);
  EXPECT_NEAR(summary.seconds, 0.199, 1e-9);
  ASSERT_EQ(summary.topics.size(), 2u);
  const TopicSummary& tool = summary.topics.at("palpate/tool_state");
  EXPECT_EQ(tool.samples, 199u);
  EXPECT_EQ(tool.gaps, 1u);
  EXPECT_EQ(tool.missing, 1u);
  EXPECT_EQ(tool.repeated, 0u);
  EXPECT_NEAR(tool.rate_hz(), 198 / 0.199, 1e-6);
  EXPECT_NEAR(static_cast<double>(tool.to_receive.percentile(0.5)), 3e5, 1e4);
  ASSERT_TRUE(summary.footer);
  EXPECT_EQ(summary.footer->lost, 0u);
}

TEST_F(PlayedLog, TheSummaryHasTheLastTaskRecordOfEachCatheterAndRun) {
  const fs::path file = file_.string() + ".task";
  {
    LogWriter writer(file);
    LogHeader header;
    header.schema = schema_text();
    writer.write(kHeaderChannel, 1, header);
    for (const std::uint64_t seq : {1u, 3u, 2u}) {  // the second came late
      TaskRecord task = task_sample();
      task.seq = seq;
      task.deepest = 0.01 * static_cast<double>(1 + seq);
      writer.write(topics::task_record.name, 10 + static_cast<std::int64_t>(seq), task);
    }
    TaskRecord other = task_sample();
    other.run = 77;
    writer.write(topics::task_record.name, 20, other);
    writer.finish();
  }
  const LogSummary summary = summarise_log(file);
  ASSERT_EQ(summary.tasks.size(), 2u);
  EXPECT_EQ(summary.tasks[0].seq, 3u);
  EXPECT_DOUBLE_EQ(summary.tasks[0].deepest, 0.04);
  EXPECT_EQ(summary.tasks[1].run, 77u);
  EXPECT_EQ(summary.topics.at("palpate/task_record").samples, 4u);
  EXPECT_TRUE(summarise_log(file_).tasks.empty());
  fs::remove(file);
}

}  // namespace
}  // namespace palpate
