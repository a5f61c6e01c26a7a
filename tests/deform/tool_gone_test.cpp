// A tool is gone with its haptic node, whoever else writes tool states.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "common/bus/memory_bus.hpp"
#include "common/realtime/clock.hpp"
#include "deform_node/dynamic_loop.hpp"
#include "tests/deform/block_bench.hpp"

namespace palpate {
namespace {

using namespace testing;

TEST(ToolGone, AToolIsGoneOnceItsHapticNodeHasEndedThoughAStrangerWrites) {
  const Scene scene = block_scene();
  const std::vector<Archive> archives{precompute_on(scene.bodies[0], middle_block_mesh())};
  DynamicWorld world(scene, archives);
  LocalModels models(world, archives, LocalStiffness::Worker::caller);
  Deformer deformer(scene, archives);
  const auto network = make_memory_network();
  const auto haptic_bus = make_memory_bus(network), bus = make_memory_bus(network),
             other_bus = make_memory_bus(network);
  const Presence haptic(*haptic_bus, "haptic", 5, "scene", "archive");
  Presence presence(*bus, "deform", 77, "scene", "archive");
  auto tools = haptic_bus->writer(topics::tool_state);
  const auto stranger = other_bus->writer(topics::tool_state);
  const auto steps = other_bus->reader(topics::deform_step, Keep::all);
  haptic_bus->writer(topics::held_topology)->write({.node = haptic.node(), .body = 0, .seq = 1});
  const ToolDofs dofs = tip_at(scene.tools[0], {0, 0, kTop + 3 * kRadius});
  ToolState state{.tool = 0, .run = 5, .seq = 1, .yaw = dofs.yaw, .pitch = dofs.pitch, .depth = dofs.depth};
  ToolState foreign = state;
  foreign.run = 6;

  DynamicLoop loop(world, models, deformer, *bus, presence, scene, 77, "");
  loop.forget_earlier_cuts();
  std::atomic<bool> over = false;
  std::thread node([&] {
    loop.run(4);
    over = true;
  });
  bool consumed = false, left = false;
  for (; !over; sleep_until_ns(now_ns() + 1'000'000)) {
    stranger->write(foreign);  // of what comes between two looks the node takes the newest
    if (tools) {
      state.seq = ++state.step;
      state.sense_ns = now_ns();
      tools->write(state);
    }
    while (const auto step = steps->take())
      for (const ConsumedStep& of : step->consumed) {
        (of.step == tool_left ? left : consumed) = true;
        EXPECT_EQ(of.run, 5u);
      }
    if (consumed && state.step > 100) tools.reset();
    ASSERT_TRUE(tools || consumed || !left) << "it goes while it is there";
  }
  node.join();
  EXPECT_TRUE(consumed);
  EXPECT_TRUE(left);
}

}  // namespace
}  // namespace palpate
