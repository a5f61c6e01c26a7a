#include <fcntl.h>
#include <gtest/gtest.h>
#include <lcm/eventlog.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <fstream>
#include <limits>
#include <random>
#include <thread>

#include "common/bus/log_reader.hpp"
#include "common/bus/log_writer.hpp"
#include "common/bus/memory_bus.hpp"
#include "common/bus/recorder.hpp"
#include "common/bus/thinning.hpp"
#include "common/realtime/clock.hpp"
#include "idl/topics.hpp"
#include "tests/bus/messages_for_tests.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;
namespace fs = std::filesystem;

class Log : public ::testing::Test {
 protected:
  Log()
      : folder_((fs::exists("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path()) /
                ("palpate_log_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    file_ = folder_ / "a.lcmlog";
  }
  ~Log() override { fs::remove_all(folder_); }

  static LogHeader header() {
    LogHeader h;
    h.scene = "title = \"x\"\n";
    h.schema = schema_text();
    h.version = "0.1.0";
    return h;
  }

  /// A log with `count` tool samples, seq 1..count, and a contact sample after every tenth.
  LogStatus write_log(int count) {
    LogWriter writer(file_);
    writer.write(kHeaderChannel, 1, header());
    for (int i = 1; i <= count; ++i) {
      writer.write(topics::tool_state.name, 1000 * i, tool_sample(static_cast<std::uint64_t>(i)));
      if (i % 10 == 0) writer.write(topics::contact_state.name, 1000 * i + 1, contact_sample(i / 10 % 4));
    }
    return writer.finish();
  }

  std::string read_file() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void overwrite(const std::string& bytes) const {
    std::ofstream(file_, std::ios::binary | std::ios::trunc)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

  /// Reads to the end; every tool sample that comes must be one that was written, in order.
  static int count_tool_samples(LogReader& reader) {
    LogEvent event;
    ToolState tool;
    int count = 0;
    std::uint64_t last = 0;
    while (reader.next(event)) {
      if (!event.read(topics::tool_state, tool)) continue;
      EXPECT_TRUE(tool == tool_sample(tool.seq));
      EXPECT_GT(tool.seq, last);
      last = tool.seq;
      ++count;
    }
    return count;
  }

  fs::path folder_, file_;
};

TEST_F(Log, GivesBackWhatWasWritten) {
  const LogStatus status = write_log(1000);
  EXPECT_EQ(status.written, 1000u + 100 + 1 + 1);
  EXPECT_EQ(status.lost, 0u);
  EXPECT_EQ(status.bytes, fs::file_size(file_));

  LogReader reader(file_);
  ASSERT_TRUE(reader.has_header());
  EXPECT_TRUE(reader.header() == header());
  LogEvent event;
  for (std::uint64_t i = 1; i <= 1000; ++i) {
    ToolState tool;
    ASSERT_TRUE(reader.next(event));
    ASSERT_TRUE(event.read(topics::tool_state, tool));
    EXPECT_TRUE(tool == tool_sample(i));
    EXPECT_EQ(event.receive_ns, static_cast<std::int64_t>(1000 * i));
    if (i % 10 != 0) continue;
    ContactState contact;
    ASSERT_TRUE(reader.next(event));
    ASSERT_TRUE(event.read(topics::contact_state, contact));
    EXPECT_TRUE(contact == contact_sample(static_cast<int>(i) / 10 % 4));
  }
  EXPECT_FALSE(reader.next(event));
  EXPECT_TRUE(reader.damage().empty());
  EXPECT_EQ(reader.damage_text(), "");
  ASSERT_TRUE(reader.footer());
  EXPECT_EQ(reader.footer()->written, 1101u);
}

TEST_F(Log, OtherProgramsReadItWithTheLcmLibrary) {
  write_log(50);
  lcm_eventlog_t* log = lcm_eventlog_create(file_.c_str(), "r");
  ASSERT_NE(log, nullptr);
  int events = 0;
  while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log)) {
    EXPECT_EQ(event->eventnum, events);
    ++events;
    lcm_eventlog_free_event(event);
  }
  lcm_eventlog_destroy(log);
  EXPECT_EQ(events, 1 + 50 + 5 + 1);
}

// A damaged log that is written anew may say any time.
TEST_F(Log, ATimeBeyondAllYearsDoesNotTurnOver) {
  LogWriter writer(file_);
  writer.write(kHeaderChannel, std::numeric_limits<std::int64_t>::max(), header());
  writer.finish();
  lcm_eventlog_t* log = lcm_eventlog_create(file_.c_str(), "r");
  lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log);
  ASSERT_TRUE(event);
  EXPECT_GT(event->timestamp, 0);
  lcm_eventlog_free_event(event);
  lcm_eventlog_destroy(log);
}

TEST_F(Log, ReadsUpToWhereItWasCutOff) {
  write_log(100);
  const std::string whole = read_file();
  const std::size_t event = 28 + std::string(topics::tool_state.name).size() + envelope::kSize + 84;
  LogReader intact(file_);
  LogEvent last;
  std::vector<std::uint64_t> starts;
  while (intact.next(last)) starts.push_back(last.offset);
  for (const std::size_t cut : {starts[60] + 1, starts[60] + event / 2, starts[60] + event - 1}) {
    overwrite(whole.substr(0, cut));
    LogReader reader(file_);
    int count = 0;
    while (reader.next(last)) ++count;
    EXPECT_EQ(count, 60);
    ASSERT_EQ(reader.damage().size(), 1u);
    EXPECT_TRUE(reader.damage()[0].tail);
    EXPECT_EQ(reader.damage()[0].offset, starts[60]);
    EXPECT_NE(reader.damage_text().find("cut off at byte " + std::to_string(starts[60])), std::string::npos);
    EXPECT_FALSE(reader.footer());
  }
}

TEST_F(Log, StepsOverADamagedPlaceAndSaysWhere) {
  write_log(100);
  const std::string whole = read_file();
  LogReader intact(file_);
  LogEvent event;
  std::vector<std::uint64_t> starts;
  while (intact.next(event)) starts.push_back(event.offset);

  // The sync word, both lengths, the channel's name, the envelope and the payload of one event in turn.
  for (const std::size_t at : {0, 20, 24, 27, 30, 28 + 18 + 2, 28 + 18 + 10, 28 + 18 + 40}) {
    std::string damaged = whole;
    damaged[starts[40] + at] = static_cast<char>(damaged[starts[40] + at] ^ 0x41);
    overwrite(damaged);
    LogReader reader(file_);
    int count = 0;
    while (reader.next(event)) ++count;
    EXPECT_EQ(count, 109) << at;
    ASSERT_EQ(reader.damage().size(), 1u) << at;
    EXPECT_EQ(reader.damage()[0].offset, starts[40]) << at;
    EXPECT_EQ(reader.damage()[0].bytes, starts[41] - starts[40]) << at;
    EXPECT_FALSE(reader.damage()[0].tail);
  }
}

TEST_F(Log, NoMutationOfItsBytesCrashesTheReaderOrForgesASample) {
  write_log(60);
  const std::string whole = read_file();
  std::mt19937 random(20240601);
  const auto below = [&](std::size_t n) { return random() % n; };
  int survivors = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::string bytes = whole;
    for (std::size_t change = 0, changes = 1 + below(4); change < changes; ++change) {
      const std::size_t at = below(bytes.size());
      switch (below(5)) {
        case 0:
          bytes[at] = static_cast<char>(random());
          break;
        case 1:
          bytes.erase(at, 1 + below(200));
          break;
        case 2:
          bytes.insert(at, std::string(1 + below(100), static_cast<char>(random())));
          break;
        case 3:
          bytes.insert(at, "\xED\xA1\xDA\x01");
          break;
        default:
          bytes.resize(std::max<std::size_t>(at, 1));
          break;
      }
      if (bytes.empty()) bytes = "x";
    }
    overwrite(bytes);
    try {
      LogReader reader(file_);
      EXPECT_LE(count_tool_samples(reader), 60);
      ++survivors;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(file_.string()), std::string::npos);
    }
    if (HasFailure()) FAIL() << "trial " << trial;
  }
  EXPECT_GT(survivors, 2000);
}

TEST_F(Log, FilesThatAreNoLogAreRefusedInWords) {
  const auto message = [&] {
    try {
      LogReader reader(file_);
      return std::string("accepted");
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
  };
  fs::remove(file_);
  EXPECT_EQ(message(), file_.string() + ": cannot be opened: No such file or directory");
  overwrite("");
  EXPECT_EQ(message(), file_.string() + ": is empty");
  overwrite(std::string(100'000, 'z'));
  EXPECT_EQ(message(), file_.string() + ": is not a topic log");

  lcm_eventlog_t* log = lcm_eventlog_create(file_.c_str(), "w");
  char channel[] = "SOMETHING", data[] = "else";
  lcm_eventlog_event_t event{0, 1, 9, 4, channel, data};
  lcm_eventlog_write_event(log, &event);
  lcm_eventlog_destroy(log);
  EXPECT_EQ(message(), file_.string() + ": is an LCM log without a readable topic of this simulator");

  {
    LogWriter writer(file_);
    LogHeader other = header();
    other.schema += "Later: x u8\n";
    other.version = "9.9";
    writer.write(kHeaderChannel, 1, other);
  }
  EXPECT_EQ(message(), file_.string() + ": was recorded by version 9.9 with other messages than this program reads");
  EXPECT_THROW(LogWriter(folder_ / "no" / "such" / "folder"), std::runtime_error);
}

TEST_F(Log, IsReadWhateverTheOrderOfItsSchema) {
  {
    LogWriter writer(file_);
    LogHeader other = header();
    const std::size_t first = other.schema.find('\n') + 1;
    other.schema = other.schema.substr(first) + other.schema.substr(0, first);
    writer.write(kHeaderChannel, 1, other);
  }
  EXPECT_NO_THROW(LogReader{file_});
}

TEST_F(Log, HasItsNameOnlyOnceItsHeaderIsInIt) {
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

TEST_F(Log, ARecorderTakesThePlaceOfALogOnlyOnceThereIsSomethingToRecord) {
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

TEST_F(Log, IsWrittenByOneAlone) {
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

TEST_F(Log, APipeIsNoLogAndIsNotWaitedFor) {
  const std::filesystem::path pipe = file_.string() + ".pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(LogReader{pipe}, std::runtime_error);
  std::filesystem::remove(pipe);
}

TEST_F(Log, AFullDiskIsCountedAndSaid) {
  LogWriter writer("/dev/full");
  for (std::uint64_t i = 0; i < 500; ++i) writer.write(topics::tool_state.name, 1, tool_sample(i));
  const LogStatus status = writer.finish();
  EXPECT_EQ(status.written, 0u);
  EXPECT_EQ(status.lost, 501u);
  EXPECT_EQ(status.error, "no space left");
}

TEST_F(Log, WhatWasWrittenBeforeAndAfterALackOfSpaceIsReadable) {
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

TEST_F(Log, AQueueThatIsFullForAMomentLosesNothing) {
  LogWriter writer(file_, 1000);
  for (std::uint64_t i = 1; i <= 1000; ++i) writer.write(topics::tool_state.name, 1, tool_sample(i));
  const LogStatus status = writer.finish();
  EXPECT_EQ(status.lost, 0u) << status.error;
  EXPECT_EQ(status.written, 1001u);
}

TEST_F(Log, AnEventLargerThanTheQueueIsWritten) {
  LogWriter writer(file_, 100);
  for (std::uint64_t i = 1; i <= 3; ++i) writer.write(topics::tool_state.name, 1, tool_sample(i));
  EXPECT_EQ(writer.finish().lost, 0u);
}

// A pipe that nobody empties stands as a disk may.
TEST_F(Log, ADiskThatStandsLosesInsteadOfBlockingForLong) {
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
