#include "deform_node/deform_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "common/bus/memory_bus.hpp"
#include "common/realtime/clock.hpp"
#include "tests/models/duct_scene.hpp"

namespace palpate {
namespace {

using namespace testing;

/// A haptic node with run 5 and an observer of surfaces beside a deformation node's loop of 10 frames a second.
struct Loop {
  DuctScene s;
  std::shared_ptr<MemoryNetwork> network = make_memory_network();
  std::unique_ptr<Bus> haptic_bus = make_memory_bus(network), bus = make_memory_bus(network),
                       observer_bus = make_memory_bus(network);
  Presence haptic{*haptic_bus, "haptic", 5, "scene", "archive"};
  Presence presence{*bus, "deform", 0, "scene", "archive"};
  Deformer deformer{s.scene, s.archives};
  std::unique_ptr<Writer<ModalState>> modes = haptic_bus->writer(topics::modal_state);
  std::unique_ptr<Writer<CatheterState>> catheters = haptic_bus->writer(topics::catheter_state);
  std::unique_ptr<Reader<SurfaceState>> surfaces = observer_bus->reader(topics::surface_state, Keep::all);
  DeformReport report;
  std::vector<SurfaceState> seen;  ///< what the observer has taken

  void observe() {
    while (auto surface = surfaces->take()) seen.push_back(std::move(*surface));
  }
  /// Until the observer has a surface of this step, or two seconds are over.
  void wait_for(std::uint64_t step) {
    const auto late = std::chrono::steady_clock::now() + std::chrono::seconds(2);
    const auto there = [&] { return std::ranges::any_of(seen, [&](const SurfaceState& x) { return x.step == step; }); };
    for (observe(); !there() && std::chrono::steady_clock::now() < late; observe())
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  /// Runs for `seconds` while `meanwhile` happens on a thread of its own.
  template <class F>
  std::vector<SurfaceState> run(double seconds, F&& meanwhile) {
    s.scene.rates.visual_hz = 10;
    DeformLoop loop(s.scene, deformer, *bus, presence);
    std::thread other(meanwhile);
    report = loop.run(seconds);
    other.join();
    observe();
    return std::exchange(seen, {});
  }
};

TEST(DeformLoop, PublishesRestShapesAtTheVisualRateUntilItHearsOfAHapticNode) {
  Loop l;
  const std::vector<SurfaceState> all = l.run(0.55, [] {});
  std::map<std::uint32_t, int> count;
  for (const SurfaceState& s : all) {
    ++count[s.body];
    EXPECT_EQ(s.run, 0u);
    EXPECT_EQ(s.position.size(), 3 * l.s.archives[s.body].surface.position.size());
  }
  for (std::uint32_t body = 0; body < 3; ++body) {
    EXPECT_GE(count[body], 3);  // the machine may be busy
    EXPECT_LE(count[body], 10 * l.report.seconds + 2);
  }
}

TEST(DeformLoop, PublishesAtOnceWhatHasChangedAndNothingElse) {
  Loop l;
  const std::vector<SurfaceState> all = l.run(5, [&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(120));
    for (int i = 1; i <= 20; ++i) {
      ModalState state = l.s.modal_state();
      state.seq = state.step = static_cast<std::uint64_t>(i);
      state.sense_ns = now_ns();
      l.modes->write(state);
      l.wait_for(state.step);
    }
  });
  std::map<std::uint32_t, int> count;
  for (const SurfaceState& s : all) ++count[s.body];
  EXPECT_GE(count[kDuctBody], 20);
  EXPECT_LE(count[kCatheterBody], 10 * l.report.seconds + 2);
  EXPECT_EQ(all.back().run, 5u);
  EXPECT_EQ(all.back().step, 20u);
  EXPECT_EQ(l.report.latency.count(), 20u);
  EXPECT_LT(l.report.latency.percentile(0.5), 20'000'000);
}

TEST(DeformLoop, ShowsTheShapesOfAHapticNodeThatCameBack) {
  Loop l;
  l.run(2, [&] {
    l.modes->write(l.s.modal_state());
    l.catheters->write(l.s.catheter_state(0.01));
  });
  EXPECT_EQ(l.deformer.run(), 5u);
  l.haptic = Presence(*l.haptic_bus, "haptic", 6, "scene", "archive");
  CatheterState state = l.s.catheter_state(0.02);
  state.run = 6;
  state.sense_ns = 5000;
  const std::vector<SurfaceState> all = l.run(3, [&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    l.catheters->write(state);
  });
  EXPECT_EQ(all.back().run, 6u);
  for (const SurfaceState& s : all) {
    if (s.run != 6) continue;
    const auto& rest = l.s.archives[s.body].surface.position;
    const double moved = s.body == kCatheterBody ? 0.02 : 0;
    for (std::size_t n = 0; n < rest.size(); ++n) EXPECT_NEAR(s.position[3 * n + 2] - rest[n].z(), moved, 1e-6);
  }
}

}  // namespace
}  // namespace palpate
