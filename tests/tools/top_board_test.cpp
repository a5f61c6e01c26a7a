#include "tools/top_board.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "common/bus/memory_bus.hpp"
#include "common/realtime/clock.hpp"
#include "idl/topics.hpp"

namespace palpate {
namespace {

/// A board that has heard of these nodes and forces.
class TopBoardTest : public ::testing::Test {
 protected:
  void hear(const NodeStatus& status) { nodes_->write(status); }
  std::shared_ptr<MemoryNetwork> network_ = make_memory_network();
  std::unique_ptr<Bus> nodes_bus_ = make_memory_bus(network_), own_bus_ = make_memory_bus(network_);
  std::unique_ptr<Writer<NodeStatus>> nodes_ = nodes_bus_->writer(topics::node_status);
  std::unique_ptr<Writer<ForceState>> forces_ = nodes_bus_->writer(topics::force_state);
  std::unique_ptr<Writer<SurfaceState>> surfaces_ = nodes_bus_->writer(topics::surface_state);
  TopBoard board_{*own_bus_};
};

TEST_F(TopBoardTest, ALatencyThatANodeDoesNotMeasureIsNoZero) {
  hear({.node = "haptic 1@here", .role = "haptic", .seq = 1, .rate_hz = 1000, .ticks = 5000});
  hear({.node = "render 2@here",
        .role = "render",
        .seq = 1,
        .rate_hz = 60,
        .ticks = 300,
        .latency_p50_us = 1500,
        .latency_p99_us = 2500});
  board_.take();
  const std::string text = board_.text(1);
  const auto line = [&](const char* node) {
    const std::size_t at = text.find(node);
    return at == text.npos ? std::string() : text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_EQ(line("haptic 1@here").find(" 0.0 "), std::string::npos) << text;
  EXPECT_NE(line("haptic 1@here").find(" - "), std::string::npos) << text;
  EXPECT_NE(line("render 2@here").find("1500.0      2500.0"), std::string::npos) << text;
  const auto json = board_.json(1);
  ASSERT_EQ(json["nodes"].size(), 2u);
  EXPECT_TRUE(json["nodes"][0]["latency_us_p50"].is_null());
  EXPECT_EQ(json["nodes"][1]["latency_us_p99"], 2500);
}

TEST_F(TopBoardTest, WordsOfOthersReachNoTerminalAsCommands) {
  hear({.node = "haptic\x1b[2J", .role = "haptic", .seq = 1, .text = "all is well\x1b]0;x\x07"});
  board_.take();
  EXPECT_EQ(board_.text(1).find_first_of("\x1b\x07"), std::string::npos) << board_.text(1);
  EXPECT_NE(board_.text(1).find("haptic?[2J"), std::string::npos) << board_.text(1);
}

TEST_F(TopBoardTest, ForcesAreCountedAnewFromLookToLook) {
  for (std::uint64_t seq = 1; seq <= 3; ++seq)
    forces_->write({.tool = 0, .run = 1, .seq = seq, .step = seq, .sense_ns = now_ns(), .force = {0, 0, 0.5}});
  board_.take();
  EXPECT_EQ(board_.json(1)["tools"][0]["steps_hz"], 3);
  EXPECT_EQ(board_.json(1)["tools"][0]["force_max_n"], 0.5);
  board_.begin_anew();
  EXPECT_EQ(board_.json(1)["tools"][0]["steps_hz"], 0);
}

// Latencies of 1 to 1000 us, each once: 997 has no divisor in common with 1000, so that they come in no order.
TEST_F(TopBoardTest, PercentilesAreThoseOfAKnownDistribution) {
  for (std::uint64_t i = 1; i <= 1000; ++i) {
    const std::int64_t sense = now_ns(), us = static_cast<std::int64_t>(997 * i % 1000) + 1;
    forces_->write({.run = 1, .seq = i, .step = i, .sense_ns = sense, .publish_ns = sense + 1000 * us});
    board_.take();
  }
  const auto force = board_.json(1)["hops_us"]["tool_to_force"];
  EXPECT_NEAR(force["p50"], 500, 500.0 / 32);
  EXPECT_NEAR(force["p90"], 900, 900.0 / 32);
  EXPECT_NEAR(force["p99"], 990, 990.0 / 32);
  EXPECT_EQ(force["max"], 1000);
  const std::string text = board_.text(1), line = text.substr(text.find("tool to force"));
  std::istringstream words(line.substr(line.find("force") + 5));
  double p50 = 0, p99 = 0, max = 0;
  words >> p50 >> p99 >> max;
  EXPECT_NEAR(p50, 500, 500.0 / 32) << text;
  EXPECT_NEAR(p99, 990, 990.0 / 32) << text;
  EXPECT_EQ(max, 1000) << text;
}

TEST_F(TopBoardTest, SaysHowLateTheTissueIs) {
  std::uint64_t seq = 0;
  const auto hear_of_tissue = [&](std::int64_t tissue_ms, std::int64_t late_ms) {
    surfaces_->write({.body = 0, .seq = ++seq, .tissue_ns = tissue_ms * 1'000'000, .late_ns = late_ms * 1'000'000});
    board_.take();
  };
  hear_of_tissue(0, 0);
  EXPECT_TRUE(board_.json(1)["tissue_s"].is_null()) << "none moves yet";
  EXPECT_EQ(board_.text(1).find("tissue"), std::string::npos);
  hear_of_tissue(2000, 5);
  board_.begin_anew();
  hear_of_tissue(2016, 5);
  hear_of_tissue(2032, 35);
  EXPECT_NE(board_.text(1).find("at 2.032 s, 0.0350 s late; lost 0.0300 s meanwhile, 0.0300 s at once at most"),
            std::string::npos)
      << board_.text(1);
  const auto tissue = board_.json(1)["tissue_s"];
  EXPECT_NEAR(tissue["late"], 0.035, 1e-9);
  EXPECT_NEAR(tissue["lost"], 0.03, 1e-9);
  board_.begin_anew();
  hear_of_tissue(2048, 35);
  EXPECT_EQ(board_.json(1)["tissue_s"]["lost"], 0.0);
}

}  // namespace
}  // namespace palpate
