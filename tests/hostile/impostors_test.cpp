// Nodes beside the real ones, or in their names.
#include <thread>

#include "common/realtime/clock.hpp"
#include "tests/hostile/hostile.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

TEST_P(Hostile, ASecondHapticAndASecondDeformNodeAreNotFollowedNorWhenTheOwnerStandsForAMoment) {
  const auto status = writer(topics::node_status);
  const auto contacts = writer(topics::contact_state);
  const auto models = writer(topics::local_contact_model);
  NodeStatus haptic = system().statuses()["haptic"], deform = system().statuses()["deform"];
  haptic.node = "haptic 1@nowhere", haptic.run = 3;
  deform.node = "deform 1@nowhere", deform.run = 5;
  for (std::uint64_t k = 0; k < 600; ++k) {
    if (k == 300) system().pause("deform");  // longer than its writers may be silent
    if (k == 400) system().go_on("deform");
    if (k % 50 == 0) haptic.seq = deform.seq = k + 1, status->write(haptic), status->write(deform);
    contacts->write({.tool = 1, .run = 3, .seq = k + 1, .step = k, .sense_ns = now_ns()});
    models->write(press(haptic_run(), 5, hand().newest().step - 2, k + 1));
    system().watch(1ms);
  }
  EXPECT_LT(hand().of(kHovering).max_force(), 0.1);
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

TEST_P(Hostile, WhoTakesTheNamesOfTheRealNodesIsNotFollowed) {
  const auto status = writer(topics::node_status);
  const auto contacts = writer(topics::contact_state);
  const auto models = writer(topics::local_contact_model);
  NodeStatus haptic = system().statuses()["haptic"], deform = system().statuses()["deform"];
  haptic.run = 3, deform.run = 5;
  const std::uint64_t run = haptic_run();
  std::atomic<bool> over = false;
  std::atomic<std::uint64_t> step = hand().newest().step;
  std::thread pretender([&] {
    for (std::uint64_t k = 1; !over; ++k) {
      haptic.seq = deform.seq = k, status->write(haptic), status->write(deform);
      contacts->write({.tool = 1, .run = 3, .seq = k, .step = k, .sense_ns = now_ns()});
      models->write(press(run, 5, step - 2, k));
      std::this_thread::sleep_for(2ms);
    }
  });
  const auto follow = [&] { step = hand().newest().step; };
  system().watch(2s, [&] { return follow(), false; });
  const bool pictures = system().pictures_go_on(kAfterFlood, follow);
  over = true;
  pretender.join();
  EXPECT_TRUE(pictures);
  EXPECT_LT(hand().of(kHovering).max_force(), 0.1);
  EXPECT_TRUE(system().watch(kAfterFlood, [] { return says("haptic", "messages are refused"); })) << "it says so";
}

// As a machine that stands may leave a node for longer than a run is held for it.
TEST_P(Hostile, ANodeThatStoodHasItsNameAndItsRunBackFromWhoSpokeInThem) {
  lied_to_ = true;
  const auto status = writer(topics::node_status);
  const auto models = writer(topics::local_contact_model);
  NodeStatus deform = system().statuses()["deform"];
  LocalContactModel nothing{.tool = kPressing, .run = deform_run(), .seq = 1u << 30, .tool_run = haptic_run()};
  const auto speak = [&] {
    ++deform.seq, status->write(deform);
    ++nothing.seq, nothing.tool_step = hand().newest().step - 2, models->write(nothing);
    return false;
  };
  system().pause("deform");
  system().watch(4s, speak);
  EXPECT_LT(hand().of(kPressing).newest().norm(), 0.1) << "the impostor was not heard";
  system().go_on("deform");
  const auto is_back = [&] {
    const FeltForce& felt = hand().of(kPressing);
    return speak() || (felt.newest() - felt.undisturbed()).norm() < 0.1 * felt.undisturbed().norm();
  };
  const std::int64_t begin = now_ns();
  EXPECT_TRUE(system().watch(20s, is_back)) << hand().of(kPressing).newest().norm() << " N";
  fmt::print("the hand has its force back after {:.2f} s\n", 1e-9 * static_cast<double>(now_ns() - begin));
  system().watch(2s, speak);
  EXPECT_TRUE(system().watch(20s, is_back)) << hand().of(kPressing).newest().norm() << " N later";
}

TEST_P(Hostile, ANodeWithoutASceneIsNoneOfThisScene) {
  const auto status = writer(topics::node_status);
  const auto models = writer(topics::local_contact_model);
  NodeStatus deform = system().statuses()["deform"];
  deform.node = "deform 0@nowhere", deform.run = 7;
  deform.scene_hash.clear(), deform.archive_hash.clear();
  for (std::uint64_t k = 0; k < 200; ++k) {
    deform.seq = k + 1;
    status->write(deform);
    models->write(press(haptic_run(), 7, hand().newest().step - 2, k + 1));
    system().watch(1ms);
  }
  EXPECT_LT(hand().of(kHovering).max_force(), 0.1);
}

TEST_P(Hostile, WhatANodeSaysOfItselfIsNoMoreThanText) {
  const auto status = writer(topics::node_status);
  NodeStatus odd = system().statuses()["render"];
  odd.node = "render \x1b[2J\xff\xfe", odd.text = "\xc3\x28 \x1b]0;\x07";
  for (std::uint64_t k = 0; k < 12; ++k) {
    odd.seq = k + 1;
    status->write(odd);
    system().watch(50ms);
  }
  EXPECT_TRUE(system().all_run());
}

}  // namespace
}  // namespace palpate::testing
