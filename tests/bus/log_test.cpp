#include <gtest/gtest.h>
#include <lcm/eventlog.h>
#include <sys/stat.h>

#include <limits>
#include <random>

#include "tests/bus/log_fixture.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;
namespace fs = std::filesystem;

class Log : public LogFixture {};

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

TEST_F(Log, APipeIsNoLogAndIsNotWaitedFor) {
  const fs::path pipe = file_.string() + ".pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(LogReader{pipe}, std::runtime_error);
  fs::remove(pipe);
}

}  // namespace
}  // namespace palpate
