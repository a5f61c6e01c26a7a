#include "deform_node/deform_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

#include "common/bus/dds_bus.hpp"
#include "common/bus/memory_bus.hpp"
#include "common/realtime/clock.hpp"
#include "tests/bus/domain.hpp"
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
  const std::vector<SurfaceState> all = l.run(1.5, [&] {
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
  l.run(0.6, [&] {
    l.modes->write(l.s.modal_state());
    l.catheters->write(l.s.catheter_state(0.01));
  });
  EXPECT_EQ(l.deformer.run(), 5u);
  l.haptic = Presence(*l.haptic_bus, "haptic", 6, "scene", "archive");
  CatheterState state = l.s.catheter_state(0.02);
  state.run = 6;
  state.sense_ns = 5000;
  const std::vector<SurfaceState> all = l.run(0.9, [&] {
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

/// A bus over DDS whose writer of surfaces takes its time, and notes which thread writes.
class WatchedBus : public Bus {
 public:
  std::atomic<std::int64_t> write_ns = 0;    ///< how long writing a surface lasts
  std::atomic<int> served = 0, by_loop = 0;  ///< surfaces that the thread which brings messages wrote, and the others

#define PALPATE_WATCHED_PORTS(M)                                                 \
  std::unique_ptr<Writer<M>> writer(const Topic<M>& topic) override {            \
    return watched(bus_->writer(topic));                                         \
  }                                                                              \
  std::unique_ptr<Reader<M>> reader(const Topic<M>& topic, Keep keep) override { \
    return bus_->reader(topic, keep);                                            \
  }
  PALPATE_MESSAGES(PALPATE_WATCHED_PORTS)
#undef PALPATE_WATCHED_PORTS

  std::string place() const override {
    return bus_->place();
  }
  std::vector<std::string> misfits() override {
    return bus_->misfits();
  }
  std::uint64_t refused() const override {
    return bus_->refused();
  }
  bool wait(std::chrono::nanoseconds timeout) override {
    return bus_->wait(timeout);
  }
  bool serve(std::function<bool()> news) override {
    return bus_->serve(std::move(news));
  }

 private:
  class WatchedWriter : public Writer<SurfaceState> {
   public:
    WatchedWriter(WatchedBus& bus, std::unique_ptr<Writer<SurfaceState>> writer)
        : bus_(bus), writer_(std::move(writer)) {}
    bool write(const SurfaceState& message) override {
      if (message.run != 0) ++(std::this_thread::get_id() == bus_.loop_ ? bus_.by_loop : bus_.served);
      std::this_thread::sleep_for(std::chrono::nanoseconds(bus_.write_ns.load()));
      return writer_->write(message);
    }
    int readers() const override { return writer_->readers(); }
    std::uint64_t refused() const override { return writer_->refused(); }
    bool delivered() const override { return writer_->delivered(); }

   private:
    WatchedBus& bus_;
    std::unique_ptr<Writer<SurfaceState>> writer_;
  };

  template <class M>
  std::unique_ptr<Writer<M>> watched(std::unique_ptr<Writer<M>> writer) {
    if constexpr (std::same_as<M, SurfaceState>)
      return std::make_unique<WatchedWriter>(*this, std::move(writer));
    else
      return writer;
  }

  std::unique_ptr<Bus> bus_ = make_dds_bus({.domain = own_domain()});
  std::thread::id loop_ = std::this_thread::get_id();
};

/// A loop over DDS of one frame a second, so that hardly any surface but those that answer a message is written, while
/// another bus of this process sends `states` in a row: within a process the thread that writes is the one that brings.
struct WatchedLoop {
  static constexpr int kStates = 40;
  DuctScene s;
  WatchedBus bus;
  std::unique_ptr<Bus> haptic_bus = make_dds_bus({.domain = own_domain()});
  Presence haptic{*haptic_bus, "haptic", 5, "scene", "archive"};
  Presence presence{bus, "deform", 0, "scene", "archive"};
  Deformer deformer{s.scene, s.archives};
  std::unique_ptr<Writer<ModalState>> modes = haptic_bus->writer(topics::modal_state);
  std::unique_ptr<Reader<SurfaceState>> surfaces = haptic_bus->reader(topics::surface_state, Keep::latest);
  std::uint64_t newest = 0;  ///< step of the newest surface

  void run() {
    s.scene.rates.visual_hz = 1;
    DeformLoop loop(s.scene, deformer, bus, presence);
    std::thread other([&] {
      for (int i = 1; i <= kStates; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        if (i == 1)
          std::this_thread::sleep_for(std::chrono::milliseconds(200));  // until the loop knows the haptic node
        ModalState state = s.modal_state();
        state.seq = state.step = static_cast<std::uint64_t>(i);
        state.sense_ns = now_ns();
        modes->write(state);
      }
    });
    loop.run(1.9);
    other.join();
    while (const auto surface = surfaces->take())
      if (surface->body == kDuctBody) newest = surface->step;
  }
};

TEST(DeformLoop, ShortAnswersAreGivenByTheThreadThatBringsTheMessage) {
  WatchedLoop l;
  l.run();
  EXPECT_GE(l.bus.served, WatchedLoop::kStates / 2) << "the machine may be busy; by the loop: " << l.bus.by_loop;
  EXPECT_EQ(l.newest, WatchedLoop::kStates);
}

TEST(DeformLoop, LongAnswersAreLeftToTheLoop) {
  WatchedLoop l;
  l.bus.write_ns = 2'000'000;
  l.run();
  EXPECT_LE(l.bus.served, 4) << "the first, by which it shows";
  EXPECT_GE(l.bus.by_loop, WatchedLoop::kStates / 2) << "the machine may be busy";
  EXPECT_EQ(l.newest, WatchedLoop::kStates);
}

}  // namespace
}  // namespace palpate
