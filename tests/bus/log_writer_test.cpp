#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "common/bus/memory_bus.hpp"
#include "common/bus/recorder.hpp"
#include "common/bus/thinning.hpp"
#include "tests/bus/log_fixture.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;
namespace fs = std::filesystem;

class WrittenLog : public LogFixture {};

TEST_F(WrittenLog, HasItsNameOnlyOnceItsHeaderIsInIt) {
  {
    const LogWriter writer(file_, header());
    EXPECT_EQ(LogReader(file_).header().schema, schema_text()) << "at once";
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "and nothing lies beside it";
  }
  EXPECT_EQ(LogReader(file_).header().version, header().version);
  fs::remove(file_);

  signal(SIGXFSZ, SIG_IGN);
  rlimit before;
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit tight = before;
  tight.rlim_cur = 100;
  setrlimit(RLIMIT_FSIZE, &tight);
  EXPECT_THROW(LogWriter(file_, header()), std::runtime_error);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_TRUE(fs::is_empty(folder_)) << "a header that does not fit leaves no file";
}

TEST_F(WrittenLog, ARecorderTakesThePlaceOfALogOnlyOnceThereIsSomethingToRecord) {
  std::ofstream(file_) << "a long session";
  const auto network = make_memory_network();
  const auto bus = make_memory_bus(network), recorders = make_memory_bus(network);
  const auto status = bus->writer(topics::node_status);
  {
    Recorder recorder(*recorders, {.file = file_, .version = "test"});
    status->write({.node = "web 1@here", .role = "web", .seq = 1});
    recorder.step(std::chrono::milliseconds(1));
    const RecorderReport report = recorder.finish();
    EXPECT_GT(report.topics.at("palpate/node_status").samples, 0u) << "who is there is no session";
    EXPECT_FALSE(report.has_log);
  }
  EXPECT_EQ(fs::file_size(file_), 14u);
  const auto tools = bus->writer(topics::tool_state);
  Recorder recorder(*recorders, {.file = file_, .version = "test"});
  tools->write(tool_sample(1));
  recorder.step(std::chrono::milliseconds(1));
  EXPECT_EQ(LogReader(file_).header().version, "test");
  EXPECT_TRUE(recorder.finish().has_log);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(WrittenLog, IsWrittenByOneAlone) {
  const auto refusal = [&] {
    try {
      LogWriter(file_, header());
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  {
    const LogWriter first(file_, header());
    EXPECT_EQ(refusal(), file_.string() + ": another program is writing it: give another name");
  }
  LogWriter second(file_, header(), WhenFull::lose, Naming::later);
  EXPECT_FALSE(second.has_name()) << "what is there stays";
  EXPECT_NE(refusal(), "accepted") << "and waits for the second alone";
  second.give_name();
  EXPECT_NE(refusal(), "accepted");
}

TEST_F(WrittenLog, AFullDiskIsCountedAndSaid) {
  LogWriter writer("/dev/full");
  for (std::uint64_t i = 0; i < 500; ++i) writer.write(topics::tool_state.name, 1, tool_sample(i));
  const LogStatus status = writer.finish();
  EXPECT_EQ(status.written, 0u);
  EXPECT_EQ(status.lost, 501u);
  EXPECT_EQ(status.error, "no space left");
}

TEST_F(WrittenLog, WhatWasWrittenBeforeAndAfterALackOfSpaceIsReadable) {
  signal(SIGXFSZ, SIG_IGN);
  rlimit before;
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit tight = before;
  tight.rlim_cur = 100'000;

  LogWriter writer(file_);
  writer.write(kHeaderChannel, 1, header());
  std::uint64_t seq = 0;
  const auto write_some = [&](int count) {
    for (int i = 0; i < count; ++i) writer.write(topics::tool_state.name, 1, tool_sample(++seq));
  };
  const auto wait_until = [&](const auto& condition) {
    for (int i = 0; i < 500 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return condition();
  };
  write_some(300);
  ASSERT_TRUE(wait_until([&] { return writer.status().bytes > 0; }));
  setrlimit(RLIMIT_FSIZE, &tight);
  write_some(5000);
  EXPECT_TRUE(wait_until([&] { return writer.status().lost > 0; }));
  setrlimit(RLIMIT_FSIZE, &before);
  std::this_thread::sleep_for(std::chrono::milliseconds(1200));
  write_some(300);
  const LogStatus status = writer.finish();
  EXPECT_EQ(status.error, "file size limit reached");
  EXPECT_EQ(status.written + status.lost, 1 + seq + 1);

  LogReader reader(file_);
  EXPECT_EQ(static_cast<std::uint64_t>(count_tool_samples(reader)), status.written - 2);
  EXPECT_GE(status.written, 602u);
  EXPECT_TRUE(reader.damage().empty());
  EXPECT_EQ(reader.footer()->lost, status.lost);
}

TEST_F(WrittenLog, AQueueThatIsFullForAMomentLosesNothing) {
  LogWriter writer(file_, 1000);
  for (std::uint64_t i = 1; i <= 1000; ++i) writer.write(topics::tool_state.name, 1, tool_sample(i));
  const LogStatus status = writer.finish();
  EXPECT_EQ(status.lost, 0u) << status.error;
  EXPECT_EQ(status.written, 1001u);
}

TEST_F(WrittenLog, AnEventLargerThanTheQueueIsWritten) {
  LogWriter writer(file_, 100);
  for (std::uint64_t i = 1; i <= 3; ++i) writer.write(topics::tool_state.name, 1, tool_sample(i));
  EXPECT_EQ(writer.finish().lost, 0u);
}

// A pipe that nobody empties stands as a disk may.
TEST_F(WrittenLog, ADiskThatStandsLosesInsteadOfBlockingForLong) {
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  const int pipe = open(file_.c_str(), O_RDWR);  // both ends: neither waits for the other
  ASSERT_GE(pipe, 0);
  LogWriter writer(file_, 1000);
  const auto begin = std::chrono::steady_clock::now();
  for (std::uint64_t i = 1; i <= 5000; ++i) writer.write(topics::tool_state.name, 1, tool_sample(i));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
  EXPECT_GT(writer.status().lost, 0u);
  EXPECT_EQ(writer.status().error, "the disk is too slow");
  std::atomic<bool> over = false;
  std::thread reader([&] {
    for (std::array<char, 65536> some{}; !over;)
      if (pollfd ready{pipe, POLLIN, 0}; poll(&ready, 1, 10) == 1) (void)!read(pipe, some.data(), some.size());
  });
  const LogStatus status = writer.finish();
  over = true;
  reader.join();
  close(pipe);
  EXPECT_EQ(status.written + status.lost, 5001u);
}

TEST(Thinning, KeepsTheFirstKeyframeOfEachRunThatItComesUponAndEveryTenthAfterIt) {
  Thinning thinning;
  thinning.steps = 17;
  std::vector<std::uint64_t> kept;
  HapticKeyframe keyframe;
  for (keyframe.run = 5; keyframe.run < 7; ++keyframe.run)
    for (keyframe.seq = keyframe.run == 5 ? 4 : 1; keyframe.seq < 26; ++keyframe.seq)
      if (thinning.keeps(keyframe)) kept.push_back(keyframe.seq);
  EXPECT_EQ(kept, (std::vector<std::uint64_t>{4, 14, 24, 1, 11, 21}));
}

}  // namespace
}  // namespace palpate
