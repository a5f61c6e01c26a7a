// Every topic at full rate into a log, and recorders that are stopped or killed meanwhile.
#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "common/bus/log_reader.hpp"
#include "common/bus/sequence.hpp"
#include "common/realtime/clock.hpp"
#include "tests/bus/domain.hpp"
#include "tests/network/network_test.hpp"
#include "tests/network/program_lines.hpp"
#include "tests/realtime/host_watch.hpp"
#include "tests/sanitized.hpp"
#include "tests/tools/comes_within.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using nlohmann::json;

/// Ten minutes in the long tests; PALPATE_LOG_SECONDS says otherwise. Three seconds, with a recorder that is stopped
/// meanwhile, are recorded in any case.
double full_rate_seconds() {
  if (const char* asked = std::getenv("PALPATE_LOG_SECONDS")) return std::atof(asked);
  return long_tests() ? 600 : 1;
}

/// What a log holds of each topic.
struct Counted {
  std::map<std::string, std::uint64_t> samples, first, last;
  std::map<std::string, SequenceCheck> sequence;
  std::int64_t last_ns = 0;
};

/// Without the statuses of the recorder, which announces itself too.
Counted count(const fs::path& file) {
  LogReader log(file);
  Counted all;
  for (LogEvent event; log.next(event);) {
    all.last_ns = event.receive_ns;
    topics::for_each([&]<class M>(const Topic<M>& topic) {
      M message;
      if (event.channel != topic.name) return;
      ASSERT_TRUE(event.read(topic, message)) << topic.name;
      if constexpr (std::same_as<M, NodeStatus>)
        if (message.role == "recorder") return;
      if (all.samples[topic.name]++ == 0) all.first[topic.name] = message.seq;
      all.last[topic.name] = message.seq;
      all.sequence[topic.name].add(message);
    });
  }
  for (const LogDamage& damage : log.damage()) EXPECT_TRUE(damage.tail) << log.damage_text();
  return all;
}

bool kept_for_late_joiners(const std::string& topic) {
  bool kept = false;
  topics::for_each([&](const auto& t) { kept = kept || (topic == t.name && t.qos.transient_local); });
  return kept;
}

constexpr double kRateHz = kSanitized ? 50 : 1000;
constexpr double kMaxSkipped = 0.1;  ///< of the publisher's ticks
constexpr double kMaxStood = 0.02;   ///< [s] of a run, in which the machine stood still

enum class Way { loopback, veth };

class FullRate : public ::testing::TestWithParam<Way> {
 protected:
  void SetUp() override {
    if (GetParam() == Way::veth) PALPATE_TWO_HOSTS_OR_SKIP(hosts_, TwoHosts::Link::veth)
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string network(const char* peer) const {
    const std::string domain = std::to_string(own_domain());
    return hosts_ ? fmt::format("{} {} {}", domain, TwoHosts::device, peer) : domain;
  }
  ChildProcess publisher(double seconds, double rate = kRateHz) const {
    const auto here = hosts_ ? std::make_unique<Inside>(hosts_->a()) : nullptr;
    return start("full_rate",
                 fmt::format("{} {} {} 1 {}", program("full_rate"), rate, seconds, network(TwoHosts::address_b)));
  }
  ChildProcess recorder(const fs::path& file) const {
    const auto here = hosts_ ? std::make_unique<Inside>(hosts_->b()) : nullptr;
    const std::string over =
        hosts_ ? fmt::format("--interface {} --peer {}", TwoHosts::device, TwoHosts::address_a) : "";
    return start("palpate", fmt::format("{} record --supervised --keep everything --domain {} {} -o {}",
                                        program("palpate"), own_domain(), over, file.string()));
  }

  /// A publisher and a recorder beside it, as they ended.
  struct Ended {
    int publisher = -1, recorder = -1;
    json written, summary;
    double rate = kRateHz;
    double skipped = 0;  ///< of the publisher's ticks
    double stood = 0;    ///< [s] the machine
    bool whole() const { return summary.value("missing", 1) == 0 && summary.value("lost", 1) == 0; }
    bool disturbed() const { return skipped > kMaxSkipped || (!whole() && stood > kMaxStood); }
  };

  /// Records a publisher for so long; `meanwhile` runs with the recorder's process in the midst of it.
  void record(double rate, double seconds, const std::function<void(pid_t)>& meanwhile, Ended& run) {
    fs::remove(log());
    ChildProcess listening = recorder(log());
    ASSERT_TRUE(says_ready(listening));
    const HostWatch host;
    const std::int64_t begin = now_ns();
    ChildProcess writing = publisher(seconds, rate);
    meanwhile(listening.pid());
    ASSERT_TRUE(writing.wait(std::chrono::milliseconds(static_cast<int>(1000 * seconds) + 60'000)));
    listening.interrupt();
    ASSERT_TRUE(listening.wait(60s));
    run = {writing.status(), listening.status(), last_line(writing), last_line(listening), rate};
    run.skipped = run.written.value("skipped", 0.0) / (rate * seconds);
    run.stood = host.stood_still(begin, now_ns());
  }

  /// Every topic has to be whole. A machine that stands still, or keeps even the publisher from its rate, holds the
  /// recorder up for longer than anybody promised: the run is repeated then, from the third on at half the rate of the
  /// one before, and the fifth is judged as it is.
  void expect_nothing_lost(double seconds, const std::function<void(pid_t)>& meanwhile) {
    Ended run;
    for (int attempt = 0; attempt < 5 && (attempt == 0 || run.disturbed()); ++attempt)
      ASSERT_NO_FATAL_FAILURE(record(attempt < 2 ? run.rate : run.rate / 2, seconds, meanwhile, run));
    EXPECT_EQ(run.publisher, 0) << run.written;
    EXPECT_EQ(run.recorder, 0);
    const json &written = run.written, &summary = run.summary;
    EXPECT_EQ(summary["missing"], 0) << summary;
    EXPECT_EQ(summary["lost"], 0) << summary;

    const Counted recorded = count(log());
    const auto expected = static_cast<std::uint64_t>(run.rate * seconds);
    std::uint64_t bytes = 0;
    topics::for_each([&](const auto& topic) {
      const json& of = written["topics"][topic.name];
      EXPECT_EQ(of["written"], expected) << topic.name;
      EXPECT_EQ(of["refused"], 0) << topic.name;
      bytes += of["bytes"].template get<std::uint64_t>();
      ASSERT_TRUE(recorded.samples.contains(topic.name)) << topic.name;
      EXPECT_EQ(recorded.samples.at(topic.name), expected) << topic.name;
      EXPECT_EQ(recorded.first.at(topic.name), 1u) << topic.name;
      EXPECT_EQ(recorded.last.at(topic.name), expected) << topic.name;
      EXPECT_EQ(recorded.sequence.at(topic.name).missing(), 0u) << topic.name;
      EXPECT_EQ(recorded.sequence.at(topic.name).repeated(), 0u) << topic.name;
    });
    fmt::print(
        "{} topics at {} Hz for {} s, {:.1f} MB/s: {} messages recorded, {} missing; the publisher skipped {} ticks\n",
        recorded.samples.size(), run.rate, seconds, 1e-6 * run.rate * static_cast<double>(bytes),
        summary["messages"].dump(), summary["missing"].dump(), written["skipped"].dump());
  }

  fs::path log() const { return folder_ / "full.lcmlog"; }

  std::unique_ptr<TwoHosts> hosts_;
  fs::path folder_ = fs::temp_directory_path() / fmt::format("palpate-full-rate-{}", getpid());
};

TEST_P(FullRate, EveryTopicIsRecordedWithoutALostMessage) {
  expect_nothing_lost(full_rate_seconds(), [](pid_t) {});
}

// A recorder is kept from running now and then: by the disk, by other programs, by the machine below.
TEST_P(FullRate, ARecorderThatStandsStillForAFifthOfASecondLosesNothing) {
  expect_nothing_lost(3, [&](pid_t recorder) {
    const auto begun = [&] { return fs::exists(log()) && fs::file_size(log()) > 400'000; };
    for (int i = 0; i < 2000 && !begun(); ++i) std::this_thread::sleep_for(5ms);
    for (int i = 0; i < 3; ++i) {
      kill(recorder, SIGSTOP);
      std::this_thread::sleep_for(200ms);
      kill(recorder, SIGCONT);
      std::this_thread::sleep_for(500ms);
    }
  });
}

class KilledRecorder : public FullRate {};

// Whatever a killed recorder leaves opens, if it is only a header.
TEST_P(KilledRecorder, LeavesALogThatOpensWhateverTheMoment) {
  ChildProcess writing = publisher(600);
  std::mt19937 random(7);
  struct Moment {
    bool ready;  ///< counted from when the recorder is ready, else from its start
    int ms;
  };
  std::vector<Moment> moments;
  for (const int ms : {0, 2, 5, 10, 15, 20, 30, 50, 80, 120}) moments.push_back({false, ms});
  for (const int ms : {0, 1, 1000}) moments.push_back({true, ms});
  for (int i = 0; i < (long_tests() ? 150 : 2); ++i) moments.push_back({true, static_cast<int>(random() % 1500)});
  int opened = 0;
  std::uint64_t most = 0;
  for (const auto& [ready, ms] : moments) {
    fs::remove(log());
    ChildProcess listening = recorder(log());
    ASSERT_TRUE(!ready || says_ready(listening));
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
    kill(listening.pid(), SIGKILL);
    ASSERT_TRUE(listening.wait(5s));
    EXPECT_TRUE(fs::exists(log()) || !ready);
    if (!fs::exists(log())) continue;
    ++opened;

    std::string said;
    ASSERT_EQ(run_command(fmt::format("{} info {} --json", program("palpate"), log().string()), &said), 0)
        << ms << " ms: " << said;
    const json info = json::parse(said);
    EXPECT_FALSE(info["complete"].get<bool>()) << ms;
    EXPECT_NE(info["version"], "") << ms;
    ASSERT_LE(info["damage"].size(), 1u) << said;
    for (const json& damage : info["damage"]) EXPECT_TRUE(damage["tail"].get<bool>()) << ms;
    // What a topic keeps for late joiners is older than what follows once the recorder has joined.
    for (const auto& [name, topic] : info["topics"].items())
      EXPECT_TRUE(topic["missing"] == 0 || kept_for_late_joiners(name)) << ms << " ms: " << name;

    const std::uint64_t forces =
        info["topics"].value("palpate/force_state", json::object()).value("samples", std::uint64_t{0});
    const std::string table = (folder_ / "force.csv").string();
    fs::remove(table);
    const int status = run_command(
        fmt::format("{} export {} --topic force_state --csv -o {}", program("palpate"), log().string(), table), &said);
    EXPECT_EQ(status, forces > 0 ? 0 : 1) << ms << " ms: " << said;
    std::ifstream in(table);
    EXPECT_EQ(in.is_open(), forces > 0) << ms;
    const auto lines = static_cast<std::uint64_t>(std::count(std::istreambuf_iterator<char>(in), {}, '\n'));
    EXPECT_EQ(lines, forces > 0 ? forces + 1 : 0) << ms;
    most = std::max(most, forces);
  }
  EXPECT_GE(opened, 5);
  EXPECT_GT(most, kSanitized ? 10u : 200u);
}

// Where little comes, no buffer fills: it is the clock that brings it to the disk.
TEST_P(KilledRecorder, HadWrittenAllButTheLastTenthOfASecond) {
  ChildProcess writing = publisher(600, 20);
  for (const auto span : {600ms, 730ms, 860ms}) {
    fs::remove(log());
    ChildProcess listening = recorder(log());
    ASSERT_TRUE(says_ready(listening));
    ASSERT_TRUE(comes_within(20s, [&] { return fs::file_size(log()) > 100'000; })) << "the writer is heard";
    std::this_thread::sleep_for(span);
    kill(listening.pid(), SIGKILL);
    const std::int64_t killed = now_ns();
    ASSERT_TRUE(listening.wait(5s));
    EXPECT_GT(count(log()).last_ns, killed - 400'000'000)
        << "a tenth of a second, the publisher's period, and this machine's load";
  }
}

std::string name_of_way(const ::testing::TestParamInfo<Way>& way) {
  return way.param == Way::loopback ? "Loopback" : "Veth";
}
INSTANTIATE_TEST_SUITE_P(Over, FullRate, ::testing::Values(Way::loopback, Way::veth), name_of_way);
INSTANTIATE_TEST_SUITE_P(Over, KilledRecorder, ::testing::Values(Way::loopback), name_of_way);

}  // namespace
}  // namespace palpate::testing
