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

/// A participant that says it is a node, or many.
struct TellerOfItself {
  Attacker attacker{{.domain = own_domain()}};
  HostileWriter<NodeStatus> writer = attacker.writer(topics::node_status);
};

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

TEST_F(GateTest, AKeyThatIsDisposedWithoutAMessageIsRefused) {
  const auto reader = bus_->reader(topics::clock_probe);
  const HostileWriter<ClockProbe> hostile = attacker_.writer(topics::clock_probe);
  until([&] { return reader->writers() == 1; });
  for (int k = 0; k < 300; ++k) hostile.dispose({.node = std::to_string(k)});
  until([&] { return reader->invalid() == 300; });
  EXPECT_EQ(bus_->refused(), 300u);
  EXPECT_FALSE(reader->take());
  hostile.write({.node = "7", .seq = 1});
  until([&] { return reader->take().has_value(); });
}

TEST_F(GateTest, OfNodesAPeerMayUseFewerNames) {
  const auto reader = bus_->reader(topics::node_status);
  const HostileWriter<NodeStatus> hostile = attacker_.writer(topics::node_status);
  until([&] { return reader->writers() == 1; });
  for (int k = 0; k < 100; ++k) hostile.write({.node = std::to_string(k)});
  until([&] { return reader->invalid() == 100 - 64; });
}

// Streams end for whoever takes as many at once as there are keys, without a message among them.
TEST_F(GateTest, WhoTakesComesToAnEndAmongStreamsThatHaveEnded) {
  const auto reader = bus_->reader(topics::node_status);
  constexpr int names = 60;
  auto one = std::make_unique<TellerOfItself>(), other = std::make_unique<TellerOfItself>();
  until([&] { return reader->writers() == 2; });
  for (int k = 0; k < names; ++k) {
    one->writer.write({.node = std::to_string(k)});
    other->writer.write({.node = std::to_string(1000 + k)});
  }
  int taken = 0, ended = 0;
  until([&] {
    while (reader->take()) ++taken;
    return taken == 2 * names;
  });
  one.reset(), other.reset();
  until([&] { return reader->writers() == 0; });
  std::this_thread::sleep_for(1s);  // all of them wait
  const auto visit = [&] {
    EXPECT_FALSE(reader->take());
    while (reader->take_ended()) ++ended;
    return ended;
  };
  EXPECT_LE(visit(), names + 4);
  until([&] { return visit() == 2 * names; });
}

TEST_F(GateTest, WhatWaitsInAReaderThatKeepsAllIsNoMoreThanItsRoom) {
  const auto reader = bus_->reader(topics::topology_change, Keep::all, 1000);
  const HostileWriter<TopologyChange> hostile = attacker_.writer(topics::topology_change);
  until([&] { return reader->writers() == 1; });
  TopologyChange change{.run = 1, .removed = std::vector<std::uint32_t>(100)};
  const auto send = [&](std::uint64_t from, std::uint64_t to) {
    for (change.seq = from; change.seq <= to; ++change.seq) {
      hostile.write(change);
      bus_->wait(1ms);
    }
  };
  send(1, 5);
  until([&] { return reader->invalid() == 3; });
  const Attacker somebody({.domain = own_domain()});
  const HostileWriter<TopologyChange> other = somebody.writer(topics::topology_change);
  until([&] { return reader->writers() == 2; });
  change.run = 2, change.seq = 100;
  other.write(change);
  change.run = 1;
  std::vector<std::uint64_t> taken;
  until([&] {
    while (const auto one = reader->take()) taken.push_back(one->seq);
    return taken.size() == 3;
  });
  EXPECT_EQ(taken, (std::vector<std::uint64_t>{1, 2, 100})) << "the other peer has room of its own";
  send(6, 6);
  until([&] { return reader->take().has_value(); });
}

TEST_F(GateTest, AWriterLastsUntilItEnds) {
  const auto reader = bus_->reader(topics::node_status);
  auto one = std::make_unique<TellerOfItself>(), other = std::make_unique<TellerOfItself>();
  const auto writer_of = [&](const TellerOfItself& node, const std::string& name) {
    until([&] { return node.writer.write({.node = name}), reader->take().has_value(); });
    return reader->taken_from();
  };
  const std::uint64_t first = writer_of(*one, "one"), second = writer_of(*other, "other");
  EXPECT_NE(first, second);
  EXPECT_TRUE(reader->lasts(first) && reader->lasts(second));
  one.reset();
  until([&] { return !reader->lasts(first); });
  EXPECT_TRUE(reader->lasts(second));
  EXPECT_FALSE(reader->lasts(0));
}

class NameTest : public GateTest {
 protected:
  NameTest() {
    until([&] { return reader_->writers() == 2; });
  }
  std::vector<std::uint64_t> runs_heard() {
    std::vector<std::uint64_t> runs;
    while (const auto status = reader_->take()) runs.push_back(status->run);
    return runs;
  }

  std::unique_ptr<Reader<NodeStatus>> reader_ = bus_->reader(topics::node_status);
  std::unique_ptr<TellerOfItself> first_ = std::make_unique<TellerOfItself>();
  const TellerOfItself second_;
  const NodeStatus real_{.node = "haptic 1@here", .run = 1}, false_{.node = "haptic 1@here", .run = 2};
};

TEST_F(NameTest, OfANodeThatIsHeardIsItsWritersAlone) {
  first_->writer.write(real_);
  until([&] { return runs_heard() == std::vector<std::uint64_t>{1}; });
  for (std::uint64_t k = 1; k <= 5; ++k) {
    second_.writer.write(false_);
    until([&] { return reader_->invalid() == k; });
  }
  EXPECT_TRUE(runs_heard().empty());
  first_->writer.write(real_);
  until([&] { return runs_heard() == std::vector<std::uint64_t>{1}; });
}

TEST_F(NameTest, IsFreeOnceItsWriterHasEnded) {
  first_->writer.write(real_);
  until([&] { return runs_heard() == std::vector<std::uint64_t>{1}; });
  first_.reset();
  const auto begin = std::chrono::steady_clock::now();
  until([&] { return second_.writer.write(false_), runs_heard() == std::vector<std::uint64_t>{2}; });
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 2s);
}

TEST_F(NameTest, IsFreeOnceItsWriterIsHeardNoMore) {
  first_->writer.write(real_);
  until([&] { return runs_heard() == std::vector<std::uint64_t>{1}; });
  std::this_thread::sleep_for(2600ms);
  second_.writer.write(false_);
  until([&] { return runs_heard() == std::vector<std::uint64_t>{2}; });
}

/// A haptic loop that has told of its run, and a stranger that speaks in it.
class RunTest : public GateTest {
 protected:
  RunTest() {
    until([&] { return statuses_->writers() == 1 && tools_->writers() == 2; });
    own_.writer.write(own_status_);
    until([&] { return statuses_->take().has_value(); });
  }
  std::vector<double> depths_heard() {
    std::vector<double> depths;
    while (const auto tool = tools_->take()) depths.push_back(tool->depth);
    return depths;
  }
  static ToolState at(double depth, std::uint64_t run = kRun) { return {.run = run, .depth = depth}; }

  static constexpr std::uint64_t kRun = 7;
  const NodeStatus own_status_{.node = "haptic 1@here", .role = "haptic", .run = kRun};
  std::unique_ptr<Reader<NodeStatus>> statuses_ = bus_->reader(topics::node_status);
  std::unique_ptr<Reader<ToolState>> tools_ = bus_->reader(topics::tool_state);
  TellerOfItself own_;
  std::unique_ptr<HostileWriter<ToolState>> own_tools_{new HostileWriter(own_.attacker.writer(topics::tool_state))};
  const HostileWriter<ToolState> other_ = attacker_.writer(topics::tool_state);
};

TEST_F(RunTest, IsItsParticipantsAloneOnAllTopicsThoughAnotherSpeaksFirst) {
  for (std::uint64_t k = 1; k <= 5; ++k) {
    other_.write(at(0.1));
    until([&] { return tools_->invalid() == k; });
  }
  EXPECT_TRUE(depths_heard().empty());
  own_tools_->write(at(0.2));
  until([&] { return depths_heard() == std::vector{0.2}; });
}

TEST_F(RunTest, OfAnotherParticipantIsItsOwn) {
  other_.write(at(0.1, 8));
  until([&] { return depths_heard() == std::vector{0.1}; });
}

TEST_F(RunTest, IsFreeOnceItsParticipantIsHeardNoMore) {
  std::this_thread::sleep_for(2600ms);
  other_.write(at(0.1));
  until([&] { return depths_heard() == std::vector{0.1}; });
}

// The name of a node that was silent is not taken by a status that is refused for its run.
TEST_F(RunTest, NoNameIsTakenByAStatusThatIsRefused) {
  const HostileWriter<NodeStatus> strangers = attacker_.writer(topics::node_status);
  until([&] { return statuses_->writers() == 2; });
  const auto end = std::chrono::steady_clock::now() + 2600ms;
  while (std::chrono::steady_clock::now() < end) {  // no status, but tools
    own_tools_->write(at(0.2));
    std::this_thread::sleep_for(100ms);
  }
  strangers.write(own_status_);
  until([&] { return statuses_->invalid() == 1; });
  own_.writer.write(own_status_);
  until([&] { return statuses_->take().has_value(); });
  EXPECT_EQ(statuses_->invalid(), 1u);
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
