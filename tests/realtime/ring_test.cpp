#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>

#include "common/realtime/spsc_ring.hpp"

namespace palpate {
namespace {

struct Record {
  std::uint64_t number = 0;
  std::array<std::uint64_t, 16> copies{};
  std::vector<std::uint64_t> list;
};

TEST(SpscRing, GivesBackWhatWasPushedInOrder) {
  SpscRing<int> ring(4);
  int value = 0;
  EXPECT_FALSE(ring.pop(value));
  for (int lap = 0; lap < 10; ++lap) {
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(10 * lap + i));
    EXPECT_FALSE(ring.push(-1));
    for (int i = 0; i < 4; ++i) {
      ASSERT_TRUE(ring.pop(value));
      EXPECT_EQ(value, 10 * lap + i);
    }
  }
}

TEST(SpscRing, RoundsItsCapacityUpToAPowerOfTwo) {
  EXPECT_EQ(SpscRing<int>(1).capacity(), 2u);
  EXPECT_EQ(SpscRing<int>(5).capacity(), 8u);
}

TEST(SpscRing, SlotsKeepTheirMemory) {
  SpscRing<Record> ring(2);
  ring.for_each_slot([](Record& record) { record.list.reserve(100); });
  for (int i = 0; i < 6; ++i) {
    Record* slot = ring.begin_push();
    ASSERT_NE(slot, nullptr);
    EXPECT_GE(slot->list.capacity(), 100u);
    slot->list.clear();
    slot->list.push_back(1);
    ring.commit_push();
    ASSERT_NE(ring.begin_pop(), nullptr);
    ring.commit_pop();
  }
}

TEST(SpscRing, TwoThreadsNeverSeeATornOrLostRecord) {
  constexpr std::uint64_t count = 100'000;
  SpscRing<Record> ring(64);
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < count;) {
      Record* slot = ring.begin_push();
      if (!slot) {
        std::this_thread::yield();
        continue;
      }
      slot->number = i;
      slot->copies.fill(i);
      slot->list.assign(i % 5, i);
      ring.commit_push();
      ++i;
    }
  });
  std::uint64_t wrong = 0;
  for (std::uint64_t i = 0; i < count;) {
    const Record* slot = ring.begin_pop();
    if (!slot) {
      std::this_thread::yield();
      continue;
    }
    if (slot->number != i || slot->list.size() != i % 5) ++wrong;
    for (std::uint64_t copy : slot->copies) wrong += copy != i;
    for (std::uint64_t copy : slot->list) wrong += copy != i;
    ring.commit_pop();
    ++i;
  }
  producer.join();
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace palpate
