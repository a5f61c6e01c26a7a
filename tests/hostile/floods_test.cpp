// More messages, names and sizes than a node has room for.
#include <thread>

#include "common/realtime/clock.hpp"
#include "tests/hostile/hostile.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

// [MB] by which a node may grow in a flood of names, or while a message after the other fills its queues.
constexpr double kFlood = 10, kLargest = 64;

bool long_form() {
  return std::getenv("PALPATE_LONG_TESTS") != nullptr;
}

/// So many messages, or with keys, where who sends them signs and encrypts them for as long again, a third of them:
/// what a name costs a node is judged more closely where all is open. The long form has all of them in both.
int flood_of(int messages, bool with_keys) {
  return with_keys && !long_form() ? messages / 3 : messages;
}

TEST_P(Hostile, ToolsWithoutNumberCostNoMemory) {
  const auto tools = writer(topics::tool_state);
  const auto contacts = writer(topics::contact_state);
  EXPECT_LT(grown_in_flood(flood_of(long_form() ? 200'000 : 30'000, GetParam()),
                           [&](std::uint32_t k) {
                             tools->write({.tool = 100 + k, .run = haptic_run(), .seq = 1});
                             contacts->write({.tool = 100 + k, .run = haptic_run(), .seq = 1});
                           }),
            kFlood);
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

TEST_P(Hostile, KeysThatAreDisposedWithoutNumberCostNoMemory) {
  const auto tools = writer(topics::tool_state);
  const auto contacts = writer(topics::contact_state);
  const auto status = writer(topics::node_status);
  EXPECT_LT(grown_in_flood(flood_of(long_form() ? 200'000 : 20'000, GetParam()),
                           [&](std::uint32_t k) {
                             tools->dispose({.tool = k});
                             contacts->dispose({.tool = k});
                             status->dispose({.node = fmt::format("render {}@there", k)});
                           }),
            kFlood);
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

TEST_P(Hostile, QuestionsForTheTimeUnderEverNewNamesKeepTheHapticNodeFromNothing) {
  const auto probes = writer(topics::clock_probe);
  EXPECT_LT(
      grown_in_flood(
          flood_of(long_form() ? 200'000 : 40'000, GetParam()),
          [&](int k) { probes->write({.node = fmt::format("render {}@there", k), .seq = 1, .publish_ns = now_ns()}); }),
      kFlood);
}

TEST_P(Hostile, AFloodOfSamplesAsFastAsTheyGoCostsNoStep) {
  const auto models = writer(topics::local_contact_model);
  const auto tools = writer(topics::tool_state);
  const auto devices = writer(topics::device_state);
  LocalContactModel model = press(haptic_run(), deform_run(), hand().newest().step, 2'000'000);
  model.contacts.clear();
  ToolState tool{.tool = kHovering, .run = haptic_run(), .depth = 0.186};
  DeviceState device{.tool = kDriven, .depth = kPressed};
  std::atomic<bool> over = false;
  std::uint64_t sent = 0;
  const std::int64_t begin = now_ns();
  std::thread flood([&] {
    while (!over) {
      ++model.seq, ++tool.seq, ++device.seq;
      sent += models->write(model) + tools->write(tool) + devices->write(device);
    }
  });
  const bool pictures = system().pictures_go_on(kAfterFlood);
  system().watch(long_form() ? 60s : 2s);
  over = true;
  flood.join();
  fmt::print("{:.0f} kHz of three topics together\n",
             1e6 * static_cast<double>(sent) / static_cast<double>(now_ns() - begin));
  EXPECT_TRUE(pictures);
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

TEST_P(Hostile, WhatOthersSayToHaveBeenCutDoesNotFillTheDeformNode) {
  const auto held = writer(topics::held_topology);
  for (std::uint64_t seq = 1; seq <= 20'000; ++seq) {
    held->write({.node = "render 1@nowhere", .body = 0, .run = deform_run(), .seq = seq, .removed = {1, 2, 3}});
    if (seq % 200 == 0) system().watch(1ms);
  }
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood)) << "the deform node hears nothing any more";
}

TEST_P(Hostile, CutsWithoutEndCostNoMemory) {
  const auto changes = writer(topics::topology_change);
  TopologyChange change{.body = 0, .run = deform_run(), .cause = fell_away};
  change.removed.assign(60'000, 1);
  for (change.seq = 2; change.seq < 150; ++change.seq) {
    changes->write(change);
    system().watch(1ms);
  }
  for (change.seq = 1'000'000'000; change.seq < 1'000'000'300; ++change.seq) changes->write(change);
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

TEST_P(Hostile, CutsLargerThanTheTissueCostNoMemory) {
  const auto changes = writer(topics::topology_change);
  TopologyChange change{.body = 0, .run = deform_run(), .cause = fell_away};
  change.removed.assign(250'000, 1);
  const Memory before = system().memory_mb();
  double grown = 0, sent_mb = 0;
  const auto end = static_cast<std::uint64_t>(flood_of(600, GetParam()));
  for (change.seq = 2; change.seq < end; ++change.seq) {
    sent_mb += changes->write(change);
    if (change.seq % 10 == 0) grown = std::max(grown, grown_since(before).mb);
  }
  fmt::print("{:.0f} MB sent, {:.0f} MB more\n", sent_mb, grown);
  EXPECT_TRUE(grown < kLargest || kSanitized) << grown << " MB";
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

}  // namespace
}  // namespace palpate::testing
