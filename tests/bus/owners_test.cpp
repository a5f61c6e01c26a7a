#include "common/bus/owners.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "tests/bus/domain.hpp"
#include "tests/hostile/attacker.hpp"

namespace palpate {
namespace {

using testing::HostileWriter;
using testing::own_domain;

/// A participant that others know of, since it writes.
struct Speaker {
  Entity participant{make_participant({.domain = own_domain()}), "speaker"};
  HostileWriter<ClockProbe> writer{participant, topics::clock_probe};
  std::uint64_t handle() const {
    dds_instance_handle_t handle = 0;
    dds_get_instance_handle(participant, &handle);
    return handle;
  }
};

class OwnersTest : public ::testing::Test {
 protected:
  OwnersTest() {
    for (int i = 0; i < 1000 && !(peers_.has(one_.handle()) && peers_.has(other_.handle())); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  static constexpr std::int64_t kNow = 1'000'000'000;

  Speaker one_, other_;
  Entity observer_{make_participant({.domain = own_domain()}), "observer"};
  Peers peers_{observer_};
  Owners<std::string> owners_{peers_};
};

// Both have looked and found it free.
TEST_F(OwnersTest, OfTwoThatComeToAFreeKeyAtOnceOneIsAdmitted) {
  ASSERT_FALSE(owners_.another("key", one_.handle(), kNow));
  ASSERT_FALSE(owners_.another("key", other_.handle(), kNow));
  EXPECT_TRUE(owners_.admit("key", one_.handle(), kNow));
  EXPECT_FALSE(owners_.admit("key", other_.handle(), kNow));
  EXPECT_FALSE(owners_.another("key", one_.handle(), kNow));
  EXPECT_TRUE(owners_.another("key", other_.handle(), kNow));
}

TEST_F(OwnersTest, WhoHasBeenSilentForAWhileHasItsKeyBackFromWhoSpokeForIt) {
  constexpr std::int64_t kHeld = Owners<std::string>::kHeldNs;
  const Speaker third;
  while (!peers_.has(third.handle())) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(owners_.admit("key", one_.handle(), kNow));
  EXPECT_FALSE(owners_.admit("key", other_.handle(), kNow + kHeld - 1));
  EXPECT_TRUE(owners_.admit("key", other_.handle(), kNow + kHeld));
  EXPECT_FALSE(owners_.admit("key", third.handle(), kNow + kHeld + 1)) << "one at a time speaks for it";
  EXPECT_TRUE(owners_.admit("key", one_.handle(), kNow + kHeld + 2));
  EXPECT_FALSE(owners_.admit("key", other_.handle(), kNow + kHeld + 3));
}

TEST_F(OwnersTest, WhatAnOwnerHadIsAnothersOnceItHasEnded) {
  std::optional<Speaker> ends(std::in_place);
  const std::uint64_t handle = ends->handle();
  while (!peers_.has(handle)) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(owners_.admit("key", handle, kNow));
  ends.reset();
  while (peers_.has(handle)) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(owners_.admit("key", one_.handle(), kNow + 1));
  EXPECT_FALSE(owners_.admit("key", other_.handle(), kNow + 2));
}

TEST_F(OwnersTest, WhoIsNotKnownComesToOwnNothing) {
  EXPECT_TRUE(owners_.admit("key", 0, kNow));
  EXPECT_TRUE(owners_.admit("key", one_.handle(), kNow));
  EXPECT_FALSE(owners_.admit("key", 0, kNow));
}

}  // namespace
}  // namespace palpate
