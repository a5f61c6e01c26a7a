#include "deform_node/earlier_cuts.hpp"

#include <gtest/gtest.h>

#include "common/bus/memory_bus.hpp"
#include "common/realtime/clock.hpp"
#include "tests/deform/block_bench.hpp"

namespace palpate {
namespace {

constexpr std::int64_t kMs = 1'000'000;

class EarlierCutsTest : public ::testing::Test {
 protected:
  void tell(const std::string& node, std::uint32_t body, std::vector<std::uint32_t> removed) {
    ASSERT_TRUE(held_->write({.node = node, .body = body, .run = 1, .seq = 1, .removed = std::move(removed)}));
  }
  bool complete(std::int64_t now) {
    presence_.watch();
    return cuts_.complete(presence_, now);
  }

  std::shared_ptr<MemoryNetwork> network_ = make_memory_network();
  std::unique_ptr<Bus> there_ = make_memory_bus(network_), here_ = make_memory_bus(network_);
  std::unique_ptr<Writer<HeldTopology>> held_ = there_->writer(topics::held_topology);
  Presence haptic_{*there_, "haptic", 1, "same", ""}, render_{*there_, "render", 0, "same", ""},
      recorder_{*there_, "recorder", 0, "", ""};
  Presence presence_{*here_, "deform", 9, "same", ""};
  EarlierCuts cuts_{*here_, {0, 2}, 100, -EarlierCuts::kMeetingNs};
};

TEST_F(EarlierCutsTest, AreCompleteOnceEveryNodeOfTheSceneHasToldOfAllBodies) {
  EXPECT_FALSE(complete(0));
  tell(haptic_.node(), 0, {});
  tell(haptic_.node(), 2, {1, 2, 3});
  EXPECT_FALSE(complete(10 * kMs)) << "the render node has not told";
  tell(render_.node(), 0, {5});
  EXPECT_FALSE(complete(20 * kMs));
  tell(render_.node(), 2, {1, 2});
  EXPECT_TRUE(complete(30 * kMs));
  EXPECT_TRUE(cuts_.in_time());
  EXPECT_EQ(cuts_.of(2)->removed, (std::vector<std::uint32_t>{1, 2, 3})) << "who knows of most is right";
  EXPECT_EQ(cuts_.of(0)->removed, std::vector<std::uint32_t>{5});
  EXPECT_EQ(cuts_.of(1), nullptr);
}

TEST_F(EarlierCutsTest, AreNotWaitedForLongerThanTwoSeconds) {
  tell(render_.node(), 0, {5});
  EXPECT_FALSE(complete(100 * kMs));
  EXPECT_FALSE(complete(2099 * kMs));
  EXPECT_TRUE(complete(2100 * kMs));
  EXPECT_FALSE(cuts_.in_time());
  EXPECT_EQ(cuts_.of(0)->removed, std::vector<std::uint32_t>{5});
}

// A render node alone remembers, and is met after the haptic node.
TEST_F(EarlierCutsTest, AreNotCompleteBeforeAllHadTheTimeToMeet) {
  auto network = make_memory_network();
  auto there = make_memory_bus(network), here = make_memory_bus(network);
  Presence haptic(*there, "haptic", 1, "same", ""), own(*here, "deform", 9, "same", "");
  const auto held = there->writer(topics::held_topology);
  EarlierCuts cuts(*here, {0}, 100, 0);
  ASSERT_TRUE(held->write({.node = haptic.node(), .body = 0, .run = 1, .seq = 1, .removed = {}}));
  own.watch();
  ASSERT_FALSE(cuts.complete(own, 200 * kMs)) << "all that it knows have told";
  Presence render(*there, "render", 0, "same", "");
  own.watch();
  ASSERT_TRUE(held->write({.node = render.node(), .body = 0, .run = 1, .seq = 1, .removed = {5}}));
  EXPECT_FALSE(cuts.complete(own, 499 * kMs));
  ASSERT_TRUE(cuts.complete(own, 500 * kMs));
  ASSERT_TRUE(cuts.of(0));
  EXPECT_EQ(cuts.of(0)->removed, std::vector<std::uint32_t>{5});
}

TEST(DynamicOrganThatBeginsCut, IsWhatTheOneThatWasCutIsAndGoesOnLikeIt) {
  testing::Bench cut(testing::block_scene());
  std::vector<int> gone;
  CutMesh mesh(cut.archives()[0].tetrahedra, cut.organ().mesh().nodes());
  for (const int t : {40, 41, 300, 1200}) mesh.remove(t, gone);
  ASSERT_GE(gone.size(), 4u);
  testing::Bench again(cut);
  const std::vector<std::uint32_t> list(gone.begin(), gone.end());
  ASSERT_TRUE(again.world().organ(0).begin_without(list));
  EXPECT_EQ(again.organ().removed(), gone);
  for (int t = 0; t < mesh.size(); ++t) ASSERT_EQ(again.organ().topology().alive(t), mesh.alive(t)) << t;
  EXPECT_EQ(again.organ().topology().visible().size(), mesh.visible().size());

  // A third one takes the second one's state over, as a replay does.
  testing::Bench third(cut);
  third.world().restore(again.world().save());
  for (int i = 0; i < 50; ++i) {
    again.tick(0.035 - 1e-4 * i);
    third.tick(0.035 - 1e-4 * i);
    ASSERT_EQ(again.world().hash(), third.world().hash()) << i;
  }
}

TEST(DynamicOrganThatBeginsCut, RefusesWhatIsNotOfItAndTakesEachOnce) {
  testing::Bench bench(testing::block_scene());
  const auto size = static_cast<std::uint32_t>(bench.organ().topology().size());
  EXPECT_FALSE(bench.world().organ(0).begin_without(std::vector<std::uint32_t>{1, size}));
  EXPECT_TRUE(bench.organ().removed().empty());
  EXPECT_EQ(bench.organ().topology().alive_count(), bench.organ().topology().size());
  EXPECT_TRUE(bench.world().organ(0).begin_without(std::vector<std::uint32_t>{5, 3, 5}));
  EXPECT_EQ(bench.organ().removed(), (std::vector<int>{5, 3}));
}

TEST(DynamicWorldWithASilentTool, KeepsItUntilItsNodeEnds) {
  testing::Bench bench(testing::block_scene());
  for (int i = 0; i < 100; ++i) bench.tick(0.034);
  const double pressed = bench.force().z();
  ASSERT_LT(pressed, -0.005);
  for (int i = 0; i < 3000; ++i) bench.world().tick();
  EXPECT_NEAR(bench.force().z(), pressed, 0.2 * -pressed);
  EXPECT_FALSE(bench.world().tool(0).has_left());
  bench.world().leave(0);
  bench.world().tick();
  EXPECT_TRUE(bench.world().tool(0).has_left());
  EXPECT_TRUE(bench.force().isZero(0));
  bench.world().leave(0);
  bench.world().tick();
  EXPECT_FALSE(bench.world().tool(0).has_left()) << "once";
  bench.tick(0.034);
  EXPECT_TRUE(bench.world().in_tick(0).present);
}

}  // namespace
}  // namespace palpate
