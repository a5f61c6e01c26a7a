#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "tests/bus/domain.hpp"
#include "tests/tools/comes_within.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/latency/hop_times.hpp"
#include "tools/latency/round_trips.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using namespace testing;
using nlohmann::json;

constexpr std::int64_t kMs = 1'000'000;

TEST(HopTimes, AreOnTheHapticNodesClock) {
  HopTimes hops;
  NodeStatus deform{.node = "deform 1@there",
                    .role = "deform",
                    .clock_of = "haptic 2@here",
                    .clock_offset_ns = -500 * kMs,
                    .clock_uncertainty_ns = 40'000};
  NodeStatus render{.node = "render 3@there",
                    .role = "render",
                    .clock_of = "haptic 2@here",
                    .clock_offset_ns = 1000 * kMs,
                    .clock_uncertainty_ns = 90'000};
  hops.add(deform);
  hops.add(render);
  hops.add(ForceState{.sense_ns = 100 * kMs, .publish_ns = 101 * kMs});
  hops.add(SurfaceState{.body = 0, .run = 7, .step = 1, .sense_ns = 100 * kMs, .publish_ns = 603 * kMs});
  hops.add(SurfaceState{
      .body = 0, .run = 7, .step = 1, .sense_ns = 100 * kMs, .publish_ns = 620 * kMs});  // shown anew, nothing new
  hops.add(SurfaceState{.body = 1, .run = 0, .step = 0, .sense_ns = 0, .publish_ns = 620 * kMs});  // rest shape
  hops.add(
      PictureState{.node = "render 3@there", .run = 7, .step = 1, .sense_ns = 1100 * kMs, .publish_ns = 116 * kMs});
  EXPECT_EQ(hops.force().max(), kMs);
  EXPECT_EQ(hops.surface().count(), 1u);
  EXPECT_EQ(hops.surface().max(), 3 * kMs);
  EXPECT_EQ(hops.picture().max(), 16 * kMs);
  EXPECT_EQ(hops.uncertainty_ns(), 90'000);
}

TEST(TissueCourse, TellsWhatWasLostWhateverOvertakesWhatAndBeginsAnewWithAnotherNode) {
  TissueCourse course;
  const auto tick = [](std::int64_t ms, std::int64_t late_ms) {
    return DeformStep{.tissue_ns = ms * kMs, .late_ns = late_ms * kMs};
  };
  EXPECT_FALSE(course.known());
  EXPECT_EQ(text_of(course), "");
  course.add(tick(5000, 2));
  EXPECT_EQ(course.lost_s(), 0) << "nobody looked before";
  course.add(tick(5001, 12));
  course.add(SurfaceState{.tissue_ns = 5000 * kMs, .late_ns = 2 * kMs});  // comes late
  course.add(tick(5002, 11));
  EXPECT_NEAR(course.time_s(), 5.002, 1e-12);
  EXPECT_NEAR(course.late_s(), 0.011, 1e-12);
  EXPECT_NEAR(course.lost_s(), 0.009, 1e-12);
  EXPECT_NEAR(course.at_once_s(), 0.010, 1e-12);
  course.add(tick(1, 0));
  course.add(tick(2, 4));
  EXPECT_NEAR(course.late_s(), 0.004, 1e-12) << "another deform node";
  EXPECT_NEAR(course.lost_s(), 0.013, 1e-12);
}

/// A way that comes back at once, but loses every seventh and gives every tenth late.
class CrookedEcho : public latency::Echo {
 public:
  void send(std::uint64_t seq) override {
    const std::lock_guard lock(mutex_);
    if (seq % 7 == 0) return;
    if (seq % 10 == 0) {
      late_ = seq;
      return;
    }
    waiting_.push_back(seq);
    if (late_ != 0 && seq > late_) waiting_.push_back(std::exchange(late_, 0));
  }
  std::uint64_t receive(std::chrono::nanoseconds) override {
    std::this_thread::sleep_for(100us);
    const std::lock_guard lock(mutex_);
    if (waiting_.empty()) return 0;
    const std::uint64_t seq = waiting_.front();
    waiting_.erase(waiting_.begin());
    return seq;
  }

 private:
  std::mutex mutex_;
  std::vector<std::uint64_t> waiting_;
  std::uint64_t late_ = 0;
};

TEST(RoundTrips, CountWhatIsLostAndWhatIsLate) {
  latency::RoundTrips trips(std::make_unique<CrookedEcho>());
  for (int i = 0; i < 20; ++i) trips.send();  // 1..20, before the measurement
  std::this_thread::sleep_for(50ms);
  trips.begin();
  for (int i = 0; i < 210; ++i) trips.send();  // 21..230
  const latency::RoundTripReport report = trips.finish();
  EXPECT_EQ(report.sent, 210u);
  EXPECT_EQ(report.lost, 30u + 1u);  // multiples of seven; 230, which nothing follows
  EXPECT_EQ(report.reordered, 17u);  // multiples of ten that are none of seven: 30..220 without 70, 140 and 210
  EXPECT_EQ(report.repeated, 0u);
  EXPECT_GT(report.time.min(), 0);
  EXPECT_GT(report.jitter_ns, 0);
}

TEST(ToolsLatency, MeasuresTheBusBesideBareDdsAndUdp) {
  const std::string domain = std::to_string(own_domain());
  const ProgramResult result = run_program(program("palpate") + " latency --seconds 1 --rate 400 --json --udp-port " +
                                           std::to_string(own_udp_port()) + " --domain " + domain);
  ASSERT_EQ(result.status, 0) << result.err;
  const json report = json::parse(result.out);
  for (const char* way : {"round_trip_us", "bare_dds_us", "bare_dds_listener_us", "bare_udp_us"}) {
    EXPECT_GT(report[way]["p50"].get<double>(), 1) << way;
    EXPECT_LE(report[way]["p50"].get<double>(), report[way]["p99"].get<double>()) << way;
    EXPECT_LE(report[way]["p999"].get<double>(), report[way]["max"].get<double>()) << way;
  }
  EXPECT_GT(report["sent"], 100) << "a busy host misses periods";
  EXPECT_LE(report["sent"], 401);
  EXPECT_EQ(report["lost"], 0);
  EXPECT_TRUE(report["hops_us"].is_null());
  EXPECT_GT(report["ratio_to_bare_dds"].get<double>(), 0.3);
  EXPECT_GT(report["ratio_to_bare_dds_listener"].get<double>(), 0.3);
}

TEST(ToolsLatency, MeasuresTheHopsOfASceneUpToThePicture) {
  const std::string scene = (std::filesystem::path(PALPATE_SOURCE) / "scenes/plate.toml").string();
  const OwnFolder folder("latency");
  const ProgramResult result =
      run_program(program("palpate") + " latency " + scene + " --seconds 1 --rate 100 -o " + folder.path().string() +
                  " --udp-port " + std::to_string(own_udp_port()) + " --domain " + std::to_string(own_domain()));
  ASSERT_EQ(result.status, 0) << result.err;
  const json hops = json::parse(text_of(folder / "latency.json"))["hops_us"];
  EXPECT_GT(hops["tool_to_force"]["p50"].get<double>(), 1);
  EXPECT_GT(hops["tool_to_surface"]["p50"].get<double>(), hops["tool_to_force"]["p50"].get<double>());
  EXPECT_GT(hops["tool_to_picture"]["p50"].get<double>(), hops["tool_to_surface"]["p50"].get<double>());
  EXPECT_EQ(hops["clock_uncertainty"], 0);
}

TEST(ToolsTop, ShowsNodesForcesAndHopsOfARunningSystem) {
  const LoopbackScene scene("top", kLinear);
  scene.write("motion.csv", "time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n2,0,0,0.198,0,0\n200,0.06,0,0.198,0,0\n");
  ASSERT_EQ(run_program(program("palpate") + " precompute " + scene.scene()).status, 0);
  const std::string domain = std::to_string(own_domain());
  ChildProcess simulation("palpate",
                          {program("palpate"), "run", scene.scene(), "--processes", "2", "--domain", domain});
  ProgramResult look;
  std::string missing;  // of what is to be seen at once
  const bool all_seen = comes_within(60s, [&] {
    look = run_program(program("palpate") + " top --once --interval 3 --domain " + domain);
    missing.clear();
    for (const char* words :
         {"haptic ", "render ", " up ", "the reference", "tool 0   force", "tool to force", "tool to picture"})
      if (look.out.find(words) == std::string::npos) missing += fmt::format("'{}' ", words);
    return missing.empty();
  });
  EXPECT_TRUE(all_seen) << missing << "\n" << look.out;
  EXPECT_EQ(look.status, 0) << look.err;
}

TEST(ToolsTop, SaysThatNobodyIsThere) {
  const ProgramResult look =
      run_program(program("palpate") + " top --once --interval 0.3 --domain " + std::to_string(own_domain()));
  EXPECT_EQ(look.status, 0) << look.err;
  EXPECT_NE(look.out.find("no node is heard of"), std::string::npos) << look.out;
}

TEST(ToolsLatency, TakesTurnsWithTheVendorsTool) {
  const std::string command = program("palpate") + " latency --ddsperf 2 --seconds 1 --rate 400 --json --udp-port " +
                              std::to_string(own_udp_port()) + " --domain " + std::to_string(own_domain());
  const ProgramResult without = run_program("PATH=/nowhere " + command);
  EXPECT_EQ(without.status, 1);
  EXPECT_NE(without.err.find("ddsperf is not installed"), std::string::npos) << without.err;
  const ProgramResult result = run_program(command);
  ASSERT_EQ(result.status, 0) << result.err;
  const json report = json::parse(result.out);
  for (const char* way : {"round_trip_us", "bare_dds_listener_us", "ddsperf_us"}) {
    ASSERT_EQ(report[way].size(), 2u) << way;
    for (const double us : report[way]) EXPECT_GT(us, 1) << way;
  }
  EXPECT_GT(report["ratio_to_ddsperf"].get<double>(), 0.1);
}

TEST(ToolsLatency, SaysWhatIsMissing) {
  const std::string palpate = program("palpate") + " latency --domain " + std::to_string(own_domain());
  expect_refusal(palpate + " nowhere.toml", {"nowhere.toml"});
  expect_refusal(palpate + " --interface lo", {"--peer"});
  expect_refusal(palpate + " --ddsperf 2 --attach", {"--ddsperf", "two processes here"});
}

}  // namespace
}  // namespace palpate
