#include <nlohmann/json.hpp>
#include <sstream>

#include "common/bus/log_writer.hpp"
#include "idl/topics.hpp"
#include "tests/tools/comes_within.hpp"
#include "tests/tools/program_result.hpp"
#include "tests/tools/unnamed_file.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace testing;
namespace fs = std::filesystem;

class Export : public ::testing::Test {
 protected:
  Export() : folder_("export"), log_(folder_ / "short.lcmlog") {
    LogWriter writer(log_);
    LogHeader header;
    header.schema = schema_text();
    writer.write(kHeaderChannel, 1, header);
    for (const std::uint64_t seq : {1u, 2u, 3u})
      writer.write(topics::force_state.name, static_cast<std::int64_t>(100 * seq),
                   ForceState{.tool = 0, .run = 9, .seq = seq, .force = {0.5, -1.0 / 3, 1e-9}, .publish_ns = 4});
    ContactState contact{.tool = 1, .seq = 1};
    contact.forces.push_back({.body = 0, .node = 7, .force = {1, 2, 3}});
    writer.write(topics::contact_state.name, 500, contact);
    writer.finish();
  }
  ProgramResult run(const std::string& rest) const {
    return run_program(program("palpate") + " export " + log_ + " " + rest);
  }

  OwnFolder folder_;
  std::string log_;
};

TEST_F(Export, ATopicAsCsvWithEveryDigit) {
  const ProgramResult result = run("--topic force_state --csv");
  ASSERT_EQ(result.status, 0) << result.err;
  std::istringstream lines(result.out);
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_TRUE(line.starts_with("receive_ns,tool,run,seq,")) << line;
  int rows = 0;
  while (std::getline(lines, line)) {
    ++rows;
    EXPECT_NE(line.find(",0.5,-0.3333333333333333,1e-09,"), std::string::npos) << line;
    EXPECT_TRUE(line.starts_with(std::to_string(100 * rows) + ",0,9," + std::to_string(rows) + ",")) << line;
  }
  EXPECT_EQ(rows, 3);
}

TEST_F(Export, StoppedByCtrlCLeavesNothing) {
  const std::string log = folder_ / "long.lcmlog";
  {
    LogWriter writer(log, LogHeader{.schema = schema_text()});
    for (std::uint64_t seq = 1; seq <= 300'000; ++seq)
      writer.write(topics::force_state.name, static_cast<std::int64_t>(100 * seq), ForceState{.run = 9, .seq = seq});
    writer.finish();
  }
  const fs::path into = folder_ / "into";
  fs::create_directory(into);
  for (const std::string kind : {"--csv -o forces.csv", "--jsonl -o forces.jsonl", "--mcap -o forces.mcap"}) {
    ChildProcess child("palpate", {"/bin/sh", "-c",
                                   fmt::format("cd {}; exec {} export {} --topic force_state {}", into.string(),
                                               program("palpate"), log, kind)});
    ASSERT_TRUE(comes_within(std::chrono::seconds(30), [&] { return bytes_on_the_way(child.pid(), into) > 0; }))
        << kind;
    child.interrupt();
    ASSERT_TRUE(child.wait(std::chrono::seconds(30)));
    EXPECT_EQ(child.status(), 130) << kind;
    EXPECT_TRUE(fs::is_empty(into)) << kind;
  }
}

TEST_F(Export, SequencesAsJsonAndIntoAFile) {
  const std::string file = folder_ / "contacts.jsonl";
  const ProgramResult result = run("--topic palpate/contact_state --jsonl -o " + file);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(result.out.empty());
  const auto sample = nlohmann::json::parse(text_of(file));
  EXPECT_EQ(sample["receive_ns"], 500);
  EXPECT_EQ(sample["message"]["forces"][0]["node"], 7);
}

TEST_F(Export, TheEndingSaysWhatIsInTheFile) {
  const std::string palpate = program("palpate") + " export " + log_;
  expect_refusal(palpate + " --mcap -o " + (folder_ / "x.csv").string(), {"x.csv does not end in .mcap"});
  expect_refusal(palpate + " --topic force_state -o " + (folder_ / "x.mcap").string(), {"x.mcap ends in .mcap"});
}

TEST_F(Export, WhereTheLogHasNoSampleNoFileIsLeftAndAnOldOneStays) {
  for (const char* to : {"none.mcap --mcap", "none.csv --csv"})
    expect_refusal(program("palpate") + " export " + log_ + " --topic modal_state -o " + (folder_ / to).string(),
                   {"short.lcmlog", "sample"});
  ASSERT_EQ(run("--topic force_state -o " + (folder_ / "old.csv").string()).status, 0);
  const std::string old = text_of(folder_ / "old.csv");
  EXPECT_EQ(run("--topic modal_state -o " + (folder_ / "old.csv").string()).status, 1);
  EXPECT_EQ(text_of(folder_ / "old.csv"), old);
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    EXPECT_TRUE(entry.path() == log_ || entry.path() == folder_ / "old.csv") << entry.path();
}

TEST_F(Export, SaysWhatItCannotDo) {
  const std::string palpate = program("palpate") + " export ";
  expect_refusal(palpate + log_ + " --topic nonsense", {"nonsense", "force_state"});
  expect_refusal(palpate + log_ + " --topic modal_state", {"no sample"});
  expect_refusal(palpate + log_ + ".not --topic force_state", {".not"});
  expect_refusal(palpate + log_ + " --topic force_state -o /nowhere/x.csv", {"/nowhere/x.csv"});
}

}  // namespace
}  // namespace palpate
