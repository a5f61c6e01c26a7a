// Moving tissue has a time of its own: each message says when it is, and how late.
#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <csignal>
#include <map>
#include <thread>

#include "common/bus/memory_bus.hpp"
#include "common/realtime/clock.hpp"
#include "deform_node/dynamic_loop.hpp"
#include "tests/deform/block_bench.hpp"

namespace palpate {
namespace {

using namespace testing;

constexpr std::int64_t kMilli = 1'000'000;
constexpr int kHeldUpMs = 80;

void stand_still(int) {
  sleep_until_ns(now_ns() + kHeldUpMs * kMilli);
}

/// A haptic node with run 5, whose tool rests in the block, beside a deformation node's loop.
class LateTick : public ::testing::Test {
 protected:
  void write_tool(std::uint64_t step) {
    const ToolDofs dofs = tip_at(scene_.tools[0], {0, 0, kTop + 0.8 * kRadius});
    tools_->write({.tool = 0,
                   .run = 5,
                   .seq = step + 1,
                   .step = step,
                   .sense_ns = now_ns(),
                   .yaw = dofs.yaw,
                   .pitch = dofs.pitch,
                   .depth = dofs.depth});
  }

  /// Everything that the loop says in a second, in which its thread is held up once.
  void run() {
    std::signal(SIGUSR1, stand_still);
    held_->write({.node = haptic_.node(), .body = 0, .seq = 1});  // nothing has been cut before
    DynamicLoop loop(world_, models_, deformer_, *bus_, presence_, scene_, 77, "");
    loop.forget_earlier_cuts();
    std::atomic<bool> over = false;
    std::thread node([&] {
      report_ = loop.run(1.5);
      over = true;
    });
    const std::int64_t begin = now_ns();
    bool held_up = false;
    for (std::uint64_t step = 0; !over; ++step) {
      write_tool(step);
      take();
      if (!held_up && now_ns() - begin > 700 * kMilli) {
        held_up = true;
        pthread_kill(node.native_handle(), SIGUSR1);
      }
      sleep_until_ns(begin + static_cast<std::int64_t>(step + 1) * kMilli);
    }
    node.join();
    take();
  }
  void take() {
    while (auto m = steps_->take()) seen_steps_.push_back(*m);
    while (auto m = surfaces_->take())
      if (m->tissue_ns > 0) seen_surfaces_.push_back(*m);
    while (auto m = local_->take()) seen_models_.push_back(*m);
  }

  Scene scene_ = block_scene();
  std::vector<Archive> archives_{precompute_on(scene_.bodies[0], middle_block_mesh())};
  DynamicWorld world_{scene_, archives_};
  LocalModels models_{world_, archives_, LocalStiffness::Worker::caller};
  Deformer deformer_{scene_, archives_};
  std::shared_ptr<MemoryNetwork> network_ = make_memory_network();
  std::unique_ptr<Bus> haptic_bus_ = make_memory_bus(network_), bus_ = make_memory_bus(network_),
                       observer_bus_ = make_memory_bus(network_);
  Presence haptic_{*haptic_bus_, "haptic", 5, "scene", "archive"};
  Presence presence_{*bus_, "deform", 77, "scene", "archive"};
  std::unique_ptr<Writer<ToolState>> tools_ = haptic_bus_->writer(topics::tool_state);
  std::unique_ptr<Writer<HeldTopology>> held_ = haptic_bus_->writer(topics::held_topology);
  std::unique_ptr<Reader<DeformStep>> steps_ = observer_bus_->reader(topics::deform_step, Keep::all);
  std::unique_ptr<Reader<SurfaceState>> surfaces_ = observer_bus_->reader(topics::surface_state, Keep::all);
  std::unique_ptr<Reader<LocalContactModel>> local_ = observer_bus_->reader(topics::local_contact_model, Keep::all);
  DynamicReport report_;
  std::vector<DeformStep> seen_steps_;
  std::vector<SurfaceState> seen_surfaces_;
  std::vector<LocalContactModel> seen_models_;
};

TEST_F(LateTick, IsSeenInEveryMessageOfTheTissue) {
  run();
  ASSERT_GT(seen_steps_.size(), 100u);
  std::map<std::int64_t, std::int64_t> late;  // by the tissue's time
  std::int64_t at_once = 0;
  for (std::size_t i = 0; i < seen_steps_.size(); ++i) {
    const DeformStep& s = seen_steps_[i];
    EXPECT_EQ(s.tissue_ns, static_cast<std::int64_t>(s.tick + 1) * kMilli);
    late[s.tissue_ns] = s.late_ns;
    if (i > 0) at_once = std::max(at_once, s.late_ns - seen_steps_[i - 1].late_ns);
  }
  EXPECT_GE(at_once, (kHeldUpMs - 1) * kMilli);
  EXPECT_GE(seen_steps_.back().late_ns, (kHeldUpMs - 1) * kMilli) << "what was left out is not made up for";
  EXPECT_EQ(report_.late_ns, seen_steps_.back().late_ns);

  // Its time and what that is late make up the time that has passed, from the first tick to when the last one began.
  const DeformStep &first = seen_steps_.front(), &last = seen_steps_.back();
  const std::int64_t passed = last.publish_ns - first.publish_ns;
  const std::int64_t told = last.tissue_ns + last.late_ns - first.tissue_ns - first.late_ns;
  EXPECT_NEAR(static_cast<double>(told), static_cast<double>(passed), 20e6);

  ASSERT_GT(seen_surfaces_.size(), 3u);
  for (const SurfaceState& s : seen_surfaces_) EXPECT_EQ(s.late_ns, late.at(s.tissue_ns));
  ASSERT_GT(seen_models_.size(), 100u);
  for (const LocalContactModel& m : seen_models_) EXPECT_EQ(m.late_ns, late.at(m.tissue_ns));
}

}  // namespace
}  // namespace palpate
