#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "common/bus/log_reader.hpp"
#include "common/bus/log_writer.hpp"
#include "idl/topics.hpp"
#include "tests/bus/messages_for_tests.hpp"

namespace palpate::testing {

/// A folder of the test's own for a log, and what is written into it and read from it.
class LogFixture : public ::testing::Test {
 protected:
  LogFixture()
      : folder_((std::filesystem::exists("/dev/shm") ? std::filesystem::path("/dev/shm")
                                                     : std::filesystem::temp_directory_path()) /
                ("palpate_log_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    file_ = folder_ / "a.lcmlog";
  }
  ~LogFixture() override { std::filesystem::remove_all(folder_); }

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

  std::filesystem::path folder_, file_;
};

}  // namespace palpate::testing
