// What a log's events come to, made by hand.
#include "tools/film/log_figures.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "idl/topics.hpp"

namespace palpate {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// Of two tetrahedra the upper one is to be cut off.
std::map<std::uint32_t, Resection> upper_of_two() {
  ElasticMesh mesh;
  mesh.rest = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}, {0, 0, -0.03}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  return {{0, Resection({{-1, -1, 0}, {1, 1, 1}}, mesh)}};
}

class Figures : public ::testing::Test {
 protected:
  template <class T, class M>
  void tell(std::int64_t receive_ns, const T& topic, const M& message) {
    LogEvent event{.channel = std::string(topic.name), .receive_ns = receive_ns};
    encode(message, event.payload);
    M again;
    ASSERT_TRUE(event.read(topic, again));
    figures_.look(event);
  }
  /// A step of a haptic node's run, with what it put on the hand.
  void step(std::int64_t receive_ns, std::uint64_t run, std::int64_t sense_ns, double newton) {
    tell(receive_ns, topics::force_state, ForceState{.run = run, .force = {newton, 0, 0}});
    tell(receive_ns, topics::tool_state, ToolState{.run = run, .sense_ns = sense_ns, .depth = 0.1});
  }
  /// Steps of a millisecond that are flagged so.
  void flagged_steps(std::uint64_t run, int from, int to, std::uint32_t flags) {
    for (int ms = from; ms < to; ++ms) {
      const auto step = static_cast<std::uint64_t>(ms);
      tell(ms * kMs, topics::force_state, ForceState{.run = run, .step = step, .flags = flags});
      tell(ms * kMs, topics::tool_state, ToolState{.run = run, .step = step, .sense_ns = ms * kMs, .depth = 0.1});
    }
  }
  double last_time() const { return figures_.course().back().time; }

  Scene scene_ = load_scene(PALPATE_SOURCE "/scenes/plate_cut.toml");
  LogFigures figures_{scene_, upper_of_two()};
};

TEST_F(Figures, ACourseHasTheLargestForceOfEachStretch) {
  for (int ms = 0; ms < 25; ++ms) step(ms * kMs, 1, ms * kMs, ms == 13 ? 2.0 : 0.5);
  ASSERT_EQ(figures_.course().size(), 3u);
  EXPECT_EQ(figures_.course()[0].force, 0.5);
  EXPECT_EQ(figures_.course()[1].force, 2);
  EXPECT_EQ(figures_.course()[2].force, 0.5);
}

// A haptic node that comes back may be on another host, whose clock began at another time.
TEST_F(Figures, EachRunOfTheHapticNodeBeginsWhereTheLogHasIt) {
  for (int ms = 0; ms < 20; ++ms) step(ms * kMs, 1, (7000 + ms) * kMs, 0.5);
  EXPECT_NEAR(last_time(), 0.01, 1e-9);
  for (int ms = 300; ms < 320; ++ms) step(ms * kMs, 2, (90 + ms) * kMs, 0.5);
  EXPECT_NEAR(last_time(), 0.31, 1e-9);
  step(500 * kMs, 2, (90 + 330) * kMs, 0.5);  // late in the log: the node's own clock knows when it was
  EXPECT_NEAR(last_time(), 0.33, 1e-9);
}

TEST_F(Figures, TheScenesTimeBeginsWithItsFirstStepWhereverTheLogDoes) {
  flagged_steps(1, 2300, 2310, 0);
  EXPECT_NEAR(figures_.scene_begin(), figures_.course()[0].time - 2.3, 1e-9);
}

TEST_F(Figures, StepsThatTheLogLacksAreCounted) {
  flagged_steps(1, 0, 10, 0);
  EXPECT_EQ(figures_.missing(), 0u);
  flagged_steps(1, 15, 20, 0);
  flagged_steps(2, 100, 110, 0);
  EXPECT_EQ(figures_.missing(), 5u) << "another run begins where it begins";
}

// As recorders write them: a batch of one topic, then one of another, and the last steps without a force.
TEST_F(Figures, EachStepHasItsOwnForceWhereverTheLogHasIt) {
  const auto newton = [](std::uint64_t step) { return step < 30 ? 0.01 * static_cast<double>(step) : 0.3; };
  const auto tools = [&](std::uint64_t from, std::uint64_t to) {
    for (std::uint64_t k = from; k < to; ++k)
      tell(to * kMs, topics::tool_state,
           ToolState{.run = 1, .step = k, .sense_ns = static_cast<std::int64_t>(k) * kMs, .depth = 0.1});
  };
  const auto forces = [&](std::uint64_t from, std::uint64_t to) {
    for (std::uint64_t k = from; k < to; ++k)
      tell(to * kMs, topics::force_state, ForceState{.run = 1, .step = k, .force = {newton(k), 0, 0}});
  };
  tools(0, 10), forces(0, 17), tools(10, 25), forces(17, 40), tools(25, 45);
  figures_.finish();
  const auto all = figures_.json()["tools"][0];
  EXPECT_NEAR(all["force_change_max_n"], 0.01, 1e-12);
  EXPECT_NEAR(all["impulse_n_s"], 1e-3 * (0.01 * 29 * 30 / 2 + 0.3 * 15), 1e-9);
  ASSERT_EQ(figures_.course().size(), 5u);
  EXPECT_NEAR(figures_.course()[1].force, newton(19), 1e-12);
}

// A run that ends fades its force as for a silent device; each of these has 20 such steps.
TEST_F(Figures, ARunsEndIsNoSilentDevice) {
  flagged_steps(1, 0, 100, 0);
  flagged_steps(1, 100, 120, silent_device);  // and it is there again
  flagged_steps(1, 120, 200, 0);
  flagged_steps(1, 200, 220, silent_device | stale_model | slew_limited);
  flagged_steps(2, 300, 400, 0);
  flagged_steps(2, 400, 420, silent_device);
  figures_.finish();
  const auto flags = figures_.json()["tools"][0]["flags"];
  EXPECT_EQ(flags["silent_device"], 20);
  EXPECT_FALSE(flags.contains("stale_model"));
  EXPECT_EQ(flags["slew_limited"], 20);
}

TEST_F(Figures, ADeviceThatIsSilentToTheEndIsOne) {
  flagged_steps(1, 0, 100, 0);
  flagged_steps(1, 100, 400, silent_device);
  figures_.finish();
  EXPECT_EQ(figures_.json()["tools"][0]["flags"]["silent_device"], 300);
}

TEST_F(Figures, ALogOfFewForcesSaysOfHowManyStepsEachIs) {
  for (int ms = 0; ms < 320; ++ms) step(ms * kMs, 1, ms * kMs, 0.5);
  EXPECT_FALSE(figures_.json()["tools"][0].contains("steps_per_force"));
  for (int ms = 320; ms < 16 * 320; ++ms)
    tell(ms * kMs, topics::tool_state, ToolState{.run = 1, .sense_ns = ms * kMs, .depth = 0.1});
  const auto thinned = figures_.json()["tools"][0];
  EXPECT_EQ(thinned["steps_per_force"], 16);
  EXPECT_FALSE(thinned.contains("force_change_max_n"));
}

TEST_F(Figures, WhatTissueHasLostAddsUpByItsCause) {
  tell(1 * kMs, topics::topology_change, TopologyChange{.run = 1, .seq = 1, .cause = cut, .removed = {1, 2, 3}});
  tell(2 * kMs, topics::topology_change, TopologyChange{.run = 1, .seq = 2, .cause = cut, .removed = {7, 8}});
  tell(3 * kMs, topics::topology_change, TopologyChange{.run = 1, .seq = 3, .cause = fell_away, .removed = {9}});
  const auto lost = figures_.json()["tissue"][0];
  EXPECT_EQ(lost["cut"], 5);
  EXPECT_EQ(lost["torn"], 0);
  EXPECT_EQ(lost["fallen"], 1);
}

TEST_F(Figures, WhatIsCutOutsideOfWhatIsMarkedIsTold) {
  tell(1 * kMs, topics::topology_change, TopologyChange{.run = 1, .seq = 1, .cause = fell_away, .removed = {0}});
  tell(2 * kMs, topics::topology_change, TopologyChange{.run = 1, .seq = 2, .cause = cut, .removed = {1, 7}});
  const auto told = figures_.json()["resections"][0];
  EXPECT_EQ(told["body"], "plate");
  EXPECT_EQ(told["cut_inside"], 0);
  EXPECT_EQ(told["cut_outside"], 1);
  EXPECT_NEAR(told["cut_outside_m3"], 3e-6 / 6, 1e-15);
}

}  // namespace
}  // namespace palpate
