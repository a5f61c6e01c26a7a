// What a reader over DDS keeps of what a stranger sends.
#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "common/bus/key_budget.hpp"
#include "common/bus/rate_budget.hpp"
#include "tests/bus/domain.hpp"
#include "tests/bus/messages_for_tests.hpp"
#include "tests/hostile/attacker.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using testing::Attacker;
using testing::HostileWriter;
using testing::own_domain;

class GateTest : public ::testing::Test {
 protected:
  template <class Done>
  void until(Done&& done) {
    const auto end = std::chrono::steady_clock::now() + 10s;
    bool met = done();
    for (; !met && std::chrono::steady_clock::now() < end; met = done()) bus_->wait(1ms);
    EXPECT_TRUE(met);
  }

  Attacker attacker_{{.domain = own_domain()}};
  std::unique_ptr<Bus> bus_ = make_dds_bus({.domain = own_domain()});
};

TEST_F(GateTest, ASampleThatCannotBeDoesNotTakeThePlaceOfOneThatCan) {
  const auto reader = bus_->reader(topics::tool_state);
  const auto writer = bus_->writer(topics::tool_state);
  const HostileWriter<ToolState> hostile = attacker_.writer(topics::tool_state);
  until([&] { return reader->writers() == 2; });
  const ToolState good = testing::tool_sample();
  ToolState bad = good;
  bad.depth = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(writer->write(good));
  ASSERT_TRUE(hostile.write(bad));
  until([&] { return reader->invalid() == 1; });
  EXPECT_EQ(bus_->refused(), 1u);
  EXPECT_EQ(reader->take(), good);
  EXPECT_FALSE(reader->take());
}

TEST_F(GateTest, AToolBeyondTheLastIsRefused) {
  const auto reader = bus_->reader(topics::tool_state);
  const HostileWriter<ToolState> hostile = attacker_.writer(topics::tool_state);
  until([&] { return reader->writers() == 1; });
  for (std::uint32_t tool = 60; tool < 70; ++tool) hostile.write(testing::tool_sample(7, tool));
  until([&] { return reader->invalid() == 6; });
  int taken = 0;
  while (reader->take()) ++taken;
  EXPECT_EQ(taken, 4);
}

TEST_F(GateTest, APeerMayUseSoManyNamesHoweverManyWritersItMakes) {
  const auto reader = bus_->reader(topics::clock_probe);
  const HostileWriter<ClockProbe> hostile[] = {attacker_.writer(topics::clock_probe),
                                               attacker_.writer(topics::clock_probe),
                                               attacker_.writer(topics::clock_probe)};
  const Attacker somebody({.domain = own_domain()});
  const HostileWriter<ClockProbe> other = somebody.writer(topics::clock_probe);
  until([&] { return reader->writers() == 4; });
  for (int k = 0; k < 300; ++k) hostile[k % 3].write({.node = std::to_string(k), .seq = 1});
  until([&] { return reader->invalid() == 300 - KeyBudget::kKeys; });
  other.write({.node = "299", .seq = 7});
  int taken = 0;
  std::uint64_t newest = 0;
  until([&] {
    while (const auto probe = reader->take()) ++taken, newest = probe->seq;
    return newest == 7;
  });
  EXPECT_EQ(taken, KeyBudget::kKeys + 1) << "another peer has names of its own";
}

TEST_F(GateTest, WhoTakesUntilThereIsNoMoreComesToAnEnd) {
  const auto reader = bus_->reader(topics::clock_probe);
  const HostileWriter<ClockProbe> one = attacker_.writer(topics::clock_probe);
  const Attacker second({.domain = own_domain()});
  const HostileWriter<ClockProbe> other = second.writer(topics::clock_probe);
  until([&] { return reader->writers() == 2; });
  for (int k = 0; k < 200; ++k)
    one.write({.node = std::to_string(k), .seq = 1}), other.write({.node = std::to_string(1000 + k), .seq = 1});
  std::this_thread::sleep_for(1s);  // all of them wait
  const auto visit = [&] {
    int taken = 0;
    while (reader->take()) ++taken;
    return taken;
  };
  EXPECT_EQ(visit(), 256);
  EXPECT_EQ(visit(), 400 - 256);
}

TEST(RateBudget, IsEachPeersOwnAndOfASecond) {
  RateBudget budget;
  int admitted = 0;
  for (std::int64_t k = 0; k < 100'000; ++k) admitted += budget.admits(1, 5'000'000'000 + 10'000 * k - 1);
  EXPECT_EQ(admitted, RateBudget::kPerSecond) << "100 kHz for a second";
  EXPECT_FALSE(budget.admits(1, 5'999'999'998));
  EXPECT_TRUE(budget.admits(2, 5'999'999'998));
  EXPECT_TRUE(budget.admits(1, 6'000'000'000));
}

// A reader that keeps all and from which nobody takes would stop the middleware's thread for all others.
TEST_F(GateTest, AReaderThatIsFullHoldsUpNoOther) {
  const auto full = bus_->reader(topics::device_state, Keep::all);
  const auto reader = bus_->reader(topics::tool_state);
  const HostileWriter<DeviceState> hostile = attacker_.writer(topics::device_state);
  const auto writer = bus_->writer(topics::tool_state);
  until([&] { return full->writers() == 1 && reader->writers() == 1; });
  for (std::uint64_t seq = 0; seq < 17'000; ++seq) {
    hostile.write({.tool = 1, .seq = seq});
    if (seq % 100 == 0) bus_->wait(1ms);
  }
  until([&] { return full->invalid() >= 1; });
  writer->write(testing::tool_sample());
  until([&] { return reader->take().has_value(); });
}

}  // namespace
}  // namespace palpate
