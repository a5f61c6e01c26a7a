#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "tests/bus/domain.hpp"
#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::LoopbackScene;
using testing::program;
using testing::run_program;

class McapExport : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<LoopbackScene>("mcap", testing::kLinear);
    const auto run = run_program(fmt::format("{} drive {} --log {}", palpate(), scene_->scene(), log().string()));
    ASSERT_EQ(run.status, 0) << run.err;
  }
  static void TearDownTestSuite() { scene_.reset(); }

  static std::string palpate() { return program("palpate"); }
  static fs::path log() { return file("run.lcmlog"); }
  static fs::path file(const std::string& name) { return scene_->folder() / name; }
  static std::unique_ptr<LoopbackScene> scene_;
};
std::unique_ptr<LoopbackScene> McapExport::scene_;

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value{};
  if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

TEST_F(McapExport, HasEveryMessageInItsSummary) {
  const auto exported =
      run_program(fmt::format("{} export {} --mcap -o {}", palpate(), log().string(), file("a.mcap").string()));
  ASSERT_EQ(exported.status, 0) << exported.err;
  const std::string bytes = testing::text_of(file("a.mcap")), magic = "\x89MCAP0\r\n";
  EXPECT_EQ(bytes.substr(0, 8), magic);
  EXPECT_EQ(bytes.substr(bytes.size() - 8), magic);
  const auto summary = number_at<std::uint64_t>(bytes, bytes.size() - 8 - 20);
  std::uint64_t messages = 0, schemas = 0, chunks = 0;
  for (std::size_t at = summary; at + 9 < bytes.size() - 8 - 29;) {  // up to the footer
    const auto opcode = static_cast<unsigned char>(bytes[at]);
    if (opcode == 3) ++schemas;
    if (opcode == 8) ++chunks;
    if (opcode == 0x0B) messages = number_at<std::uint64_t>(bytes, at + 9);
    at += 9 + number_at<std::uint64_t>(bytes, at + 1);
  }
  const json info = json::parse(run_program(palpate() + " info --json " + log().string()).out);
  std::uint64_t samples = 0;
  for (const auto& topic : info["topics"]) samples += topic["samples"].get<std::uint64_t>();
  EXPECT_EQ(messages, samples);
  EXPECT_EQ(schemas, info["topics"].size());
  EXPECT_GT(chunks, 1u);
}

TEST_F(McapExport, OfNothingIsRefused) {
  testing::expect_refusal(palpate() + " export " + log().string() + " --mcap", {"--mcap needs a file"});
  testing::expect_refusal(palpate() + " export " + log().string(), {"give --topic"});
  testing::expect_refusal(
      palpate() + " export " + log().string() + " --mcap --topic nonsense -o " + file("n.mcap").string(),
      {"there is no topic"});
  testing::expect_refusal(palpate() + " export " + log().string() + " --mcap --topic top -o " + file("n.mcap").string(),
                          {"there is no topic"});
  testing::expect_refusal(palpate() + " export " + log().string() + " --mcap -o /nowhere/n.mcap",
                          {"/nowhere/n.mcap", "cannot be written"});
}

TEST_F(McapExport, SaysWhyItCannotBeWritten) {
  const auto full = testing::run_program("trap \"\" XFSZ; ulimit -f 4; " + palpate() + " export " + log().string() +
                                         " --mcap -o " + file("full.mcap").string());
  EXPECT_EQ(full.status, 1);
  EXPECT_NE(full.err.find("full.mcap: cannot be written: File too large"), std::string::npos) << full.err;
  EXPECT_FALSE(std::filesystem::exists(file("full.mcap")));
}

// With the reference reader and the decoder of another project, where they are installed: scripts/nightly.sh mcap.
class McapInTheReferenceReader : public McapExport {
 protected:
  void SetUp() override {
    if (!modules_)
      GTEST_SKIP() << "PALPATE_MCAP_READER names no folder with node_modules/@mcap/core: scripts/nightly.sh mcap";
  }
  /// What it says of a log's export beside what `info` and `export` say of the log.
  std::string said_of(const fs::path& log) const {
    const fs::path here = fs::path(modules_) / "check.mjs";  // beside its modules
    fs::copy_file(PALPATE_SOURCE "/tests/mcap/check.mjs", here, fs::copy_options::overwrite_existing);
    const fs::path exported = file("b.mcap"), info = file("info.json");
    const std::string of_log = " export " + log.string();
    EXPECT_EQ(run_program(palpate() + of_log + " --mcap -o " + exported.string()).status, 0);
    std::ofstream(info) << run_program(palpate() + " info --json " + log.string()).out;
    std::string command = fmt::format("node {} {} {}", here.string(), exported.string(), info.string());
    const json topics = json::parse(testing::text_of(info))["topics"];
    for (const auto& [topic, summary] : topics.items()) {
      const fs::path rows = file(fs::path(topic).filename().string() + ".jsonl");
      EXPECT_EQ(run_program(palpate() + of_log + " --topic " + topic + " --jsonl -o " + rows.string()).status, 0);
      command += fmt::format(" {}={}", topic, rows.string());
    }
    const auto checked = run_program(command);
    EXPECT_EQ(checked.status, 0) << checked.err;
    return checked.out;
  }
  const char* modules_ = std::getenv("PALPATE_MCAP_READER");
};

TEST_F(McapInTheReferenceReader, EveryMessageAgreesWithTheLog) {
  const std::string said = said_of(log());
  EXPECT_NE(said.find("messages of"), std::string::npos) << said;
}

// In lock step all latencies are nothing: these are of a run of the nodes.
TEST_F(McapInTheReferenceReader, LatenciesComputedFromItAreThoseOfInfo) {
  const fs::path recorded = file("nodes.lcmlog");
  const auto run = run_program(fmt::format("{} run {} --seconds 2 --processes 3 --domain {} --record {}", palpate(),
                                           scene_->scene(), testing::own_domain(), recorded.string()));
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string said = said_of(recorded);
  const std::size_t at = said.find("agree, and ");
  ASSERT_NE(at, std::string::npos) << said;
  EXPECT_GE(std::stoi(said.substr(at + 11)), 6) << said;
}

}  // namespace
}  // namespace palpate
