#include "common/node/topology_memory.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "common/bus/memory_bus.hpp"

namespace palpate {
namespace {

using List = std::vector<int>;
using Changed = std::vector<int>;

/// Three bodies, of which the second can be cut; a deformation node on the same network whose changes the test writes.
class TopologyMemoryTest : public ::testing::Test {
 protected:
  TopologyMemoryTest() {
    archives_.resize(3);
    archives_[1].tetrahedra.resize(100);
  }
  Presence deform_node(std::uint64_t run, const std::string& scene = "same") {
    return {*there_, "deform", run, scene, "archive"};
  }
  void change(std::uint64_t run, std::uint64_t seq, std::vector<std::uint32_t> removed, std::uint32_t body = 1) {
    ASSERT_TRUE(changes_->write({.body = body, .run = run, .seq = seq, .removed = std::move(removed)}));
  }
  Changed take() {
    presence_.watch();
    return memory_->take();
  }
  HeldTopology told() {
    std::this_thread::sleep_for(std::chrono::milliseconds(60));  // it tells no more often
    take();
    HeldTopology last;
    while (auto held = held_->take()) last = std::move(*held);
    return last;
  }
  void make() { memory_.emplace(*here_, presence_, archives_); }

  std::shared_ptr<MemoryNetwork> network_ = make_memory_network();
  std::unique_ptr<Bus> there_ = make_memory_bus(network_), here_ = make_memory_bus(network_);
  std::vector<Archive> archives_;
  std::unique_ptr<Writer<TopologyChange>> changes_ = there_->writer(topics::topology_change);
  std::unique_ptr<Reader<HeldTopology>> held_ = there_->reader(topics::held_topology, Keep::all);
  Presence presence_{*here_, "haptic", 7, "same", "archive"};
  std::optional<TopologyMemory> memory_;
};

TEST_F(TopologyMemoryTest, KnowsEveryChangeOfTheRunItHasMetAlsoThoseFromBefore) {
  const Presence node = deform_node(5);
  change(5, 1, {});
  change(5, 2, {3, 4});
  make();
  change(5, 3, {9});
  EXPECT_EQ(take(), Changed{1});
  EXPECT_EQ(memory_->removed(1), (List{3, 4, 9}));
  EXPECT_EQ(memory_->run(1), 5u);
  EXPECT_EQ(take(), Changed{});
}

TEST_F(TopologyMemoryTest, LooksAtNoChangeOfAStrangersSceneOrOfAnUnknownRun) {
  const Presence stranger = deform_node(6, "another");
  make();
  change(6, 1, {1});
  change(8, 1, {2});
  EXPECT_EQ(take(), Changed{});
  EXPECT_EQ(memory_->removed(1), List{});
}

TEST_F(TopologyMemoryTest, RefusesWhatDoesNotFitTheArchives) {
  const Presence node = deform_node(5);
  make();
  change(5, 1, {100});
  change(5, 1, {1}, 0);
  change(5, 1, {1}, 17);
  EXPECT_EQ(take(), Changed{});
  EXPECT_EQ(memory_->refused(), 3u);
  change(5, 2, {99});
  EXPECT_EQ(take(), Changed{1}) << "it is not asked for again for ever";
  EXPECT_EQ(memory_->removed(1), List{99});
}

TEST_F(TopologyMemoryTest, HoldsOnToWhatItKnowsUntilAnotherRunSaysWhatIsGone) {
  auto first = std::make_unique<Presence>(deform_node(5));
  make();
  change(5, 1, {});
  change(5, 2, {3, 4});
  take();
  const Presence second = deform_node(6);
  EXPECT_EQ(take(), Changed{});
  EXPECT_EQ(memory_->removed(1), (List{3, 4})) << "the returning node asks for it";
  change(6, 1, {3, 4});
  change(6, 2, {5});
  EXPECT_EQ(take(), Changed{1});
  EXPECT_EQ(memory_->removed(1), (List{3, 4, 5}));
  EXPECT_EQ(memory_->run(1), 6u);
}

TEST_F(TopologyMemoryTest, TellsWhatItKnowsAtItsStartAndAfterEachChange) {
  const Presence node = deform_node(5);
  make();
  HeldTopology first = *held_->take();
  EXPECT_EQ(first.node, presence_.node());
  EXPECT_EQ(first.body, 1u);
  EXPECT_EQ(first.run, 0u);
  EXPECT_TRUE(first.removed.empty());
  EXPECT_FALSE(held_->take()) << "of the body that can be cut alone";
  change(5, 1, {8});
  change(5, 2, {6, 7});
  take();
  const HeldTopology held = told();
  EXPECT_EQ(held.run, 5u);
  EXPECT_EQ(held.removed, (std::vector<std::uint32_t>{8, 6, 7}));
}

}  // namespace
}  // namespace palpate
