#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <thread>

#include "common/node/node_setup.hpp"

namespace palpate {
namespace {

// Of two nodes that both began, that with the smaller number stays (Presence): the one that has been there longer.
TEST(RunNumber, OfAnEarlierStartIsSmaller) {
  std::set<std::uint64_t> numbers;
  std::uint64_t last = 0;
  for (int k = 0; k < 20; ++k) {
    const std::uint64_t now = new_run();
    EXPECT_GT(now, last);
    last = now;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  for (int k = 0; k < 100; ++k) numbers.insert(new_run());
  EXPECT_GT(numbers.size(), 95u) << "two that start at once differ";
}

}  // namespace
}  // namespace palpate
