#include "common/bus/presence.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "common/bus/memory_bus.hpp"
#include "common/realtime/clock.hpp"

namespace palpate {
namespace {

/// A node, and others of which nothing is there but what they say.
class PresenceTest : public ::testing::Test {
 protected:
  void say(const std::string& role, std::uint64_t run, std::uint64_t ticks, const std::string& scene = "scene",
           const std::string& archive = "archive") {
    NodeStatus status{.node = role + std::to_string(run), .role = role, .run = run, .seq = 1, .stamp_ns = now_ns()};
    status.scene_hash = scene;
    status.archive_hash = archive;
    status.ticks = ticks;
    ASSERT_TRUE(others_->write(status));
  }

  std::shared_ptr<MemoryNetwork> network_ = make_memory_network();
  std::unique_ptr<Bus> here_ = make_memory_bus(network_), there_ = make_memory_bus(network_);
  std::unique_ptr<Writer<NodeStatus>> others_ = there_->writer(topics::node_status);
};

TEST_F(PresenceTest, AnEmptyHashIsAnotherSceneUnlessItIsARecorders) {
  Presence render(*here_, "render", 0, "scene", "archive"), recorder(*here_, "recorder", 0, "", "");
  say("haptic", 1, 0);
  say("haptic", 2, 0, "", "");
  say("haptic", 3, 0, "scene", "");
  say("recorder", 4, 0, "", "");
  render.watch();
  recorder.watch();
  EXPECT_TRUE(render.accepts(1));
  EXPECT_FALSE(render.accepts(2));
  EXPECT_FALSE(render.accepts(3));
  EXPECT_TRUE(render.matched("recorder"));
  EXPECT_TRUE(recorder.accepts(1));
}

TEST_F(PresenceTest, AnOwnerThatRunsKeepsItAndTheNextIsTold) {
  Presence second(*here_, "haptic", 4, "scene", "archive"), render(*here_, "render", 0, "scene", "archive");
  say("haptic", 1, 700, "another scene");
  second.watch();
  EXPECT_NO_THROW(second.claim("the tools"));
  say("haptic", 9, 500);
  say("render", 0, 500);
  second.watch();
  render.watch();
  EXPECT_THROW(second.claim("the tools"), std::runtime_error);
  EXPECT_EQ(second.owner()->run, 9u);
  EXPECT_NO_THROW(render.claim("the picture")) << "there may be any number of them";
}

TEST_F(PresenceTest, WhatIsThereOncePerDomainHasOneOwnerWhateverTheScene) {
  Presence second(*here_, "haptic", 4, "scene", "archive");
  say("haptic", 9, 700, "another scene");
  second.watch();
  EXPECT_NO_THROW(second.claim("the moving tissue"));
  EXPECT_THROW(second.claim("the tools", Presence::Of::domain), std::runtime_error);
}

TEST_F(PresenceTest, OfTwoThatClaimedBeforeTheyMetOneGivesWay) {
  Presence lower(*here_, "haptic", 4, "scene", "archive"), higher(*here_, "haptic", 900, "scene", "archive");
  lower.claim("the tools");
  higher.claim("the tools");
  EXPECT_EQ(lower.lost_claim(), "");
  say("haptic", 9, 1);
  lower.watch();
  higher.watch();
  EXPECT_EQ(lower.lost_claim(), "");
  EXPECT_NE(higher.lost_claim().find("has the tools"), std::string::npos) << higher.lost_claim();
}

TEST_F(PresenceTest, TheOneMetFirstKeepsTheWordWhileItIsHeard) {
  Presence render(*here_, "render", 0, "scene", "archive");
  say("haptic", 9, 500);
  render.watch();
  say("haptic", 4, 900);
  render.watch();
  EXPECT_TRUE(render.accepts(9));
  EXPECT_FALSE(render.accepts(4));
  EXPECT_EQ(render.holder("haptic")->status.run, 9u);
}

TEST_F(PresenceTest, NamesWithoutEndAreNotRemembered) {
  Presence render(*here_, "render", 0, "scene", "archive");
  std::size_t said = 0;
  for (std::uint64_t run = 1; run < 1000; ++run) {
    say("web", run, 0);
    said += render.watch().size();
  }
  EXPECT_LE(render.peers().size(), 256u);
  EXPECT_LE(said, 256u);
}

TEST_F(PresenceTest, ANodeOfThisSceneIsHeardHoweverManyOthersAre) {
  Presence render(*here_, "render", 0, "scene", "archive");
  say("haptic", 1, 7);
  for (std::uint64_t run = 1; run < 300; ++run) say("web", run, 0, "another scene");
  render.watch();
  say("deform", 2, 7);
  render.watch();
  EXPECT_TRUE(render.accepts(1));
  EXPECT_TRUE(render.matched("deform"));
  EXPECT_LE(render.peers().size(), 256u);
}

TEST_F(PresenceTest, ANodeIsHeardHoweverOftenItHasBegunAnew) {
  Presence render(*here_, "render", 0, "scene", "archive");
  for (std::uint64_t run = 1; run <= 256; ++run) say("deform", run, 7);
  render.watch();
  ASSERT_EQ(render.peers().size(), 256u);
  say("deform", 257, 7);
  render.watch();
  EXPECT_FALSE(render.peers().contains("deform257")) << "all of the others are heard";
  std::this_thread::sleep_for(std::chrono::milliseconds(2600));
  say("deform", 257, 7);
  EXPECT_EQ(render.watch(), std::vector<std::string>{"met deform257"});
  EXPECT_EQ(render.holder("deform")->status.run, 257u);
}

TEST_F(PresenceTest, WhatANodeSaysOfItselfIsPrintable) {
  Presence render(*here_, "render", 0, "scene", "archive");
  NodeStatus status{.node = "web \x1b[2J", .role = "web", .run = 1, .seq = 1, .scene_hash = "scene"};
  status.archive_hash = "archive";
  status.text = "\xff\n";
  ASSERT_TRUE(others_->write(status));
  EXPECT_EQ(render.watch(), std::vector<std::string>{"met web ?[2J"});
  EXPECT_EQ(render.holder("web")->status.text, "??");
}

TEST_F(PresenceTest, OfTwoThatBeginAtOnceOneGivesWay) {
  Presence lower(*here_, "deform", 4, "scene", "archive"), higher(*here_, "deform", 12, "scene", "archive");
  say("deform", 9, 0);
  lower.watch();
  higher.watch();
  EXPECT_EQ(lower.owner(), nullptr);
  ASSERT_NE(higher.owner(), nullptr);
  EXPECT_EQ(higher.owner()->run, 9u);
}

}  // namespace
}  // namespace palpate
