#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "common/bus/dds_bus.hpp"
#include "common/bus/memory_bus.hpp"
#include "tests/bus/domain.hpp"
#include "tests/bus/messages_for_tests.hpp"

/// What every bus promises, over memory and over DDS within one process.
namespace palpate {
namespace {

using namespace std::chrono_literals;
using namespace palpate::testing;

class BusContract : public ::testing::TestWithParam<const char*> {
 protected:
  BusContract() {
    if (std::string(GetParam()) == "memory") {
      auto network = make_memory_network();
      a = make_memory_bus(network);
      b = make_memory_bus(network);
    } else {
      a = make_dds_bus({.domain = own_domain()});
      b = make_dds_bus({.domain = own_domain()});
    }
  }

  template <class M>
  std::optional<M> take_within(Bus& bus, Reader<M>& reader, std::chrono::milliseconds limit = 5s) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (std::chrono::steady_clock::now() < end) {
      if (auto message = reader.take()) return message;
      bus.wait(20ms);
    }
    return std::nullopt;
  }

  static bool eventually(const std::function<bool()>& condition) {
    for (int i = 0; i < 500 && !condition(); ++i) std::this_thread::sleep_for(10ms);
    return condition();
  }

  template <class M>
  void expect_round_trip(const Topic<M>& topic, const M& message) {
    auto reader = b->reader(topic);
    auto writer = a->writer(topic);
    ASSERT_TRUE(eventually([&] { return writer->readers() == 1 && reader->writers() == 1; })) << topic.name;
    ASSERT_TRUE(writer->write(message)) << topic.name;
    const auto received = take_within(*b, *reader);
    ASSERT_TRUE(received) << topic.name;
    EXPECT_TRUE(*received == message) << topic.name;
  }

  std::unique_ptr<Bus> a, b;
};

TEST_P(BusContract, EveryFieldOfEveryMessageArrivesAsItWasSent) {
  expect_round_trip(topics::tool_state, tool_sample());
  expect_round_trip(topics::device_state, device_sample());
  expect_round_trip(topics::contact_state, contact_sample());
  expect_round_trip(topics::held_contacts, contact_sample(0));
  expect_round_trip(topics::force_state, force_sample());
  expect_round_trip(topics::surface_state, surface_sample(7000));
  expect_round_trip(topics::node_status, status_sample());
  expect_round_trip(topics::haptic_keyframe, keyframe_sample());
  expect_round_trip(topics::scene, scene_sample());
  expect_round_trip(topics::topology_change, topology_sample());
  expect_round_trip(topics::held_topology, held_topology_sample());
  expect_round_trip(topics::local_contact_model, local_model_sample());
  expect_round_trip(topics::local_contact_model, local_model_sample(32, 128));
  expect_round_trip(topics::deform_step, deform_step_sample());
  expect_round_trip(topics::deform_keyframe, deform_keyframe_sample());
  expect_round_trip(topics::modal_state, modal_sample());
  expect_round_trip(topics::modal_state, modal_sample(1024, 4096));
  expect_round_trip(topics::creep_state, creep_sample());
  expect_round_trip(topics::creep_state, creep_sample(4096));
  expect_round_trip(topics::catheter_state, catheter_sample());
  expect_round_trip(topics::catheter_state, catheter_sample(1024));
  expect_round_trip(topics::task_record, task_sample());
  expect_round_trip(topics::clock_probe, probe_sample());
  expect_round_trip(topics::clock_answer, answer_sample());
  expect_round_trip(topics::picture_state, picture_sample());
}

TEST_P(BusContract, ALateReaderGetsEveryChangeOfTopologyInOrder) {
  constexpr std::uint64_t changes = 3000;  // more than any topic that keeps the last ones
  auto writer = a->writer(topics::topology_change);
  for (std::uint64_t seq = 1; seq <= changes; ++seq) ASSERT_TRUE(writer->write(topology_sample(seq)));
  auto late = b->reader(topics::topology_change, Keep::all);
  for (std::uint64_t seq = 1; seq <= changes; ++seq) {
    const auto change = take_within(*b, *late);
    ASSERT_TRUE(change) << seq;
    ASSERT_EQ(change->seq, seq);
  }
  TopologyChange unknown = topology_sample(changes + 1);
  unknown.cause = gone_before + 1;
  EXPECT_FALSE(writer->write(unknown));
  ASSERT_TRUE(writer->write(topology_sample(changes + 1)));
  EXPECT_EQ(take_within(*b, *late)->seq, changes + 1);
}

TEST_P(BusContract, LocalContactModelsThatCannotBeAreRefused) {
  auto writer = a->writer(topics::local_contact_model);
  const auto refused = [&](auto&& change) {
    LocalContactModel model = local_model_sample(3, 4);
    EXPECT_TRUE(writer->write(model));
    change(model);
    return !writer->write(model);
  };
  EXPECT_TRUE(refused([](auto& m) { m.triangles[1].b = static_cast<std::uint32_t>(m.nodes.size()); }));
  EXPECT_TRUE(refused([](auto& m) { m.contacts[2].normal = {0, 0, 1.001}; }));
  EXPECT_TRUE(refused([](auto& m) { m.contacts[2].grasped = 2; }));
  EXPECT_TRUE(refused([](auto& m) { m.contacts[0].stiffness[8] = std::numeric_limits<double>::infinity(); }));
  EXPECT_TRUE(refused([](auto& m) { m.nodes[0].velocity[1] = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](auto& m) { m.contacts.resize(33, m.contacts[0]); }));
  EXPECT_TRUE(refused([](auto& m) { m.nodes.resize(193, m.nodes[0]); }));
  EXPECT_TRUE(refused([](auto& m) { m.triangles.resize(129, m.triangles[0]); }));
  EXPECT_TRUE(refused([](auto& m) { m.seq = 0; }));
  EXPECT_FALSE(refused([](auto& m) { m.contacts.resize(32, m.contacts[0]); }));
}

TEST_P(BusContract, TimesWithWhichNobodyCanReckonAreRefused) {
  auto writer = a->writer(topics::clock_answer);
  EXPECT_TRUE(writer->write(answer_sample()));
  for (const std::int64_t time : {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    ClockAnswer answer = answer_sample();
    answer.receive_ns = time;
    EXPECT_FALSE(writer->write(answer));
    answer = answer_sample();
    answer.publish_ns = time;
    EXPECT_FALSE(writer->write(answer));
  }
}

TEST_P(BusContract, ReducedStatesAndTaskRecordsThatCannotBeAreRefused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](const auto& topic, auto message, auto&& change) {
    auto writer = a->writer(topic);
    EXPECT_TRUE(writer->write(message));
    change(message);
    return !writer->write(message);
  };
  const auto modal = [&](auto&& change) { return refused(topics::modal_state, modal_sample(), change); };
  EXPECT_TRUE(modal([&](auto& m) { m.coordinates[1] = nan; }));
  EXPECT_TRUE(modal([&](auto& m) { m.forces[2].force[0] = std::numeric_limits<float>::infinity(); }));
  EXPECT_TRUE(modal([](auto& m) { m.coordinates.resize(1025); }));
  EXPECT_TRUE(modal([](auto& m) { m.forces.resize(4097); }));
  EXPECT_FALSE(modal([](auto& m) { m.coordinates.resize(1024); }));

  const auto catheter = [&](auto&& change) { return refused(topics::catheter_state, catheter_sample(), change); };
  EXPECT_TRUE(catheter([&](auto& m) { m.position[4] = nan; }));
  EXPECT_TRUE(catheter([](auto& m) { m.position.pop_back(); }));
  EXPECT_TRUE(catheter([](auto& m) { m.position.resize(3 * 1025); }));
  EXPECT_FALSE(catheter([](auto& m) { m.position.resize(3 * 1024); }));

  const auto task = [&](auto&& change) { return refused(topics::task_record, task_sample(), change); };
  EXPECT_TRUE(task([&](auto& m) { m.max_force = nan; }));
  EXPECT_TRUE(task([](auto& m) { m.inserted = m.deepest + 0.001; }));
  EXPECT_TRUE(task([](auto& m) { m.held_s = -1; }));
  EXPECT_FALSE(task([](auto& m) { m.inserted = 0; }));
}

TEST_P(BusContract, AReaderOfTheLatestSkipsOlderSamplesOfTheSameKeyOnly) {
  auto reader = b->reader(topics::tool_state);
  auto writer = a->writer(topics::tool_state);
  ASSERT_TRUE(eventually([&] { return writer->readers() == 1; }));
  for (std::uint64_t seq = 1; seq <= 50; ++seq)
    for (std::uint32_t tool : {0u, 1u}) ASSERT_TRUE(writer->write(tool_sample(seq, tool)));
  std::array<std::uint64_t, 2> last{};
  int taken = 0;
  ASSERT_TRUE(eventually([&] {
    while (auto message = reader->take()) last[message->tool] = message->seq, ++taken;
    return last[0] == 50 && last[1] == 50;
  }));
  EXPECT_LE(taken, 100);
}

TEST_P(BusContract, AReaderOfAllGetsEverySampleInOrder) {
  auto reader = b->reader(topics::force_state, Keep::all);
  auto writer = a->writer(topics::force_state);
  ASSERT_TRUE(eventually([&] { return writer->readers() == 1; }));
  for (std::uint64_t seq = 0; seq < 1500; ++seq) {
    ForceState message = force_sample();
    message.seq = seq;
    ASSERT_TRUE(writer->write(message));
  }
  for (std::uint64_t seq = 0; seq < 1500; ++seq) {
    const auto message = take_within(*b, *reader);
    ASSERT_TRUE(message);
    ASSERT_EQ(message->seq, seq);
  }
}

TEST_P(BusContract, ALateReaderGetsWhatATransientLocalTopicKeepsAndNothingElse) {
  auto held = a->writer(topics::held_contacts);
  auto tool = a->writer(topics::tool_state);
  ContactState message = contact_sample();
  for (std::uint32_t key : {4u, 5u})
    for (std::uint64_t seq : {1u, 2u}) {
      message.tool = key, message.seq = seq;
      ASSERT_TRUE(held->write(message));
    }
  ASSERT_TRUE(tool->write(tool_sample()));

  auto late = b->reader(topics::held_contacts, Keep::all);
  auto late_tool = b->reader(topics::tool_state, Keep::all);
  int taken = 0;
  while (auto sample = take_within(*b, *late, taken < 2 ? 5000ms : 100ms)) {
    EXPECT_EQ(sample->seq, 2u);
    ++taken;
  }
  EXPECT_EQ(taken, 2);
  EXPECT_FALSE(late_tool->take());
}

TEST_P(BusContract, InvalidSamplesAreRefused) {
  auto reader = b->reader(topics::tool_state);
  auto surface_reader = b->reader(topics::surface_state);
  auto writer = a->writer(topics::tool_state);
  auto surface = a->writer(topics::surface_state);
  ASSERT_TRUE(eventually([&] { return writer->readers() == 1; }));
  ToolState bad = tool_sample();
  bad.depth = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(writer->write(bad));
  SurfaceState unequal = surface_sample(4);
  unequal.normal.pop_back();
  EXPECT_FALSE(surface->write(unequal));
  EXPECT_EQ(writer->refused(), 1u);
  EXPECT_EQ(surface->refused(), 1u);
  ASSERT_TRUE(writer->write(tool_sample(99)));
  EXPECT_EQ(take_within(*b, *reader)->seq, 99u);
  EXPECT_FALSE(surface_reader->take());
}

TEST_P(BusContract, AWriterThatGoesIsNoticed) {
  auto reader = b->reader(topics::contact_state);
  auto writer = a->writer(topics::contact_state);
  ASSERT_TRUE(eventually([&] { return reader->writers() == 1; }));
  writer.reset();
  EXPECT_TRUE(eventually([&] { return reader->writers() == 0; }));
}

TEST_P(BusContract, WaitLastsAsLongAsNothingComes) {
  auto reader = b->reader(topics::tool_state);
  auto writer = a->writer(topics::tool_state);
  ASSERT_TRUE(eventually([&] { return writer->readers() == 1 && reader->writers() == 1; }));
  while (b->wait(0ns) && reader->take()) {
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(b->wait(50ms));
  EXPECT_GE(std::chrono::steady_clock::now() - start, 45ms);

  std::thread later([&] {
    std::this_thread::sleep_for(50ms);
    writer->write(tool_sample());
  });
  EXPECT_TRUE(b->wait(10s));
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
  later.join();
}

TEST_P(BusContract, WhoServesIsCalledByTheThreadThatBringsWhatComesAndWaitWakesForWhatIsLeft) {
  auto reader = b->reader(topics::tool_state);
  auto writer = a->writer(topics::tool_state);
  ASSERT_TRUE(eventually([&] { return writer->readers() == 1 && reader->writers() == 1; }));
  std::vector<std::uint64_t> served;  // of this thread alone: within a process the writer's brings it
  bool leave = false;
  const auto news = [&] {
    if (leave) return false;
    while (const auto message = reader->take()) served.push_back(message->seq);
    return true;
  };
  if (!b->serve(news)) {  // wait() as ever
    ASSERT_TRUE(writer->write(tool_sample(1)));
    EXPECT_TRUE(b->wait(10s));
    EXPECT_EQ(reader->take()->seq, 1u);
    EXPECT_STREQ(GetParam(), "memory");
    return;
  }
  EXPECT_TRUE(b->wait(10s)) << "something may have come before";
  for (const std::uint64_t seq : {1, 2}) {
    ASSERT_TRUE(writer->write(tool_sample(seq)));
    EXPECT_EQ(served.size(), seq);
  }
  EXPECT_FALSE(b->wait(20ms)) << "it was served";
  leave = true;
  ASSERT_TRUE(writer->write(tool_sample(3)));
  EXPECT_TRUE(b->wait(10s));
  EXPECT_FALSE(b->wait(20ms)) << "once";
  EXPECT_EQ(reader->take()->seq, 3u);
  leave = false;
  b->serve({});
  ASSERT_TRUE(writer->write(tool_sample(4)));
  EXPECT_EQ(served, (std::vector<std::uint64_t>{1, 2}));
  EXPECT_TRUE(b->wait(10s)) << "as ever";
  EXPECT_EQ(reader->take()->seq, 4u);
}

TEST_P(BusContract, WhatComesWhileWhoServesIsCalledIsServedAfterIt) {
  auto reader = b->reader(topics::tool_state, Keep::all);
  auto answers = b->reader(topics::force_state, Keep::all);
  auto writer = a->writer(topics::tool_state);
  auto answer = b->writer(topics::force_state);
  ASSERT_TRUE(eventually([&] { return writer->readers() == 1 && answer->readers() == 1; }));
  int under_way = 0, most = 0;
  std::atomic<std::uint64_t> served = 0, answered = 0;
  const bool serves = b->serve([&] {
    most = std::max(most, ++under_way);
    while (reader->take()) {
      ++served;
      answer->write(force_sample());  // comes to this bus at once, on this thread
    }
    while (answers->take()) ++answered;
    --under_way;
    return true;
  });
  if (!serves) return;
  constexpr std::uint64_t each = 200;
  const auto write = [&] {
    const auto own = a->writer(topics::tool_state);
    for (std::uint64_t seq = 1; seq <= each; ++seq) own->write(tool_sample(seq));
  };
  std::thread one(write), other(write);
  one.join();
  other.join();
  EXPECT_TRUE(eventually([&] { return served == 2 * each && answered == 2 * each; })) << served << " " << answered;
  b->serve({});
  EXPECT_EQ(most, 1) << "one call at a time";
}

INSTANTIATE_TEST_SUITE_P(Buses, BusContract, ::testing::Values("memory", "dds"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace palpate
