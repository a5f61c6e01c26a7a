#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <thread>

#include "common/bus/dds_bus.hpp"
#include "common/bus/log_reader.hpp"
#include "common/bus/recorder.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/histogram.hpp"
#include "common/realtime/periodic.hpp"
#include "tests/bus/domain.hpp"
#include "tests/bus/messages_for_tests.hpp"

/// The bus between real processes over DDS on loopback.
namespace palpate {
namespace {

using namespace std::chrono_literals;
using namespace palpate::testing;

constexpr std::uint64_t kMany = 2000;  ///< samples of a topic: two seconds of them

/// Another process; it ends with the object.
class Peer {
 public:
  Peer(const char* role, int domain) {
    const std::string number = std::to_string(domain);
    pid_ = fork();
    if (pid_ == 0) {
      execl(PALPATE_BUS_PEER, "bus_peer", role, number.c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
  }
  ~Peer() { end(SIGTERM); }
  Peer(const Peer&) = delete;

  std::uint64_t run() const { return static_cast<std::uint64_t>(pid_); }
  void send(int signal) const { kill(pid_, signal); }
  void end(int signal) {
    if (pid_ <= 0) return;
    kill(pid_, SIGCONT);
    kill(pid_, signal);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }

 private:
  pid_t pid_ = -1;
};

class TwoProcesses : public ::testing::Test {
 protected:
  const int domain = own_domain();
  std::unique_ptr<Bus> bus = make_dds_bus({.domain = domain});

  template <class M>
  std::optional<M> take_within(Reader<M>& reader, std::chrono::milliseconds limit = 10s) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (std::chrono::steady_clock::now() < end) {
      if (auto message = reader.take()) return message;
      bus->wait(20ms);
    }
    return std::nullopt;
  }

  static bool eventually(const std::function<bool()>& condition, std::chrono::milliseconds limit = 10s) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!condition() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(2ms);
    return condition();
  }
};

TEST_F(TwoProcesses, AMessageGoesThereAndBack) {
  Peer peer("echo", domain);
  const auto tool = bus->writer(topics::tool_state);
  const auto force = bus->reader(topics::force_state, Keep::all);
  const auto send = [&](std::uint64_t seq) {
    ToolState message = tool_sample(seq);
    message.sense_ns = now_ns();
    tool->write(message);
    return message.sense_ns;
  };
  // That both are seen here does not say that the peer sees this reader yet: what it answers before then is lost.
  std::optional<ForceState> first;
  ASSERT_TRUE(eventually([&] { return send(0), take_within(*force, 100ms).has_value(); }));
  for (std::uint64_t seq = 1; seq <= 300; ++seq) {
    const std::int64_t sense_ns = send(seq);
    auto answer = take_within(*force);
    while (answer && answer->seq == 0) answer = take_within(*force);
    ASSERT_TRUE(answer);
    ASSERT_EQ(answer->seq, seq);
    ASSERT_EQ(answer->sense_ns, sense_ns);
  }
}

TEST_F(TwoProcesses, ALateJoinerGetsSceneStatusAndHeldContacts) {
  Peer peer("publish", domain);
  const auto tool = bus->reader(topics::tool_state);
  ASSERT_TRUE(take_within(*tool));
  const auto late = make_dds_bus({.domain = domain});
  const auto scene = late->reader(topics::scene);
  const auto status = late->reader(topics::node_status);
  const auto held = late->reader(topics::held_contacts);
  SceneText expected = scene_sample();
  expected.run = peer.run();
  const auto text = take_within(*scene);
  ASSERT_TRUE(text);
  EXPECT_TRUE(*text == expected);
  EXPECT_EQ(take_within(*status)->run, peer.run());
  EXPECT_TRUE(*take_within(*held) == contact_sample());
}

TEST_F(TwoProcesses, ALargeSurfaceArrivesWhole) {
  Peer peer("publish", domain);
  const auto reader = bus->reader(topics::surface_state);
  SurfaceState expected = surface_sample(7000);
  for (int i = 0; i < 20; ++i) {
    const auto surface = take_within(*reader);
    ASSERT_TRUE(surface);
    EXPECT_EQ(surface->run, peer.run());
    EXPECT_EQ(surface->position, expected.position);
    EXPECT_EQ(surface->normal, expected.normal);
  }
}

TEST_F(TwoProcesses, AKilledWriterIsMissedWithinASecondAndItsSuccessorTakenUp) {
  auto first = std::make_unique<Peer>("publish", domain);
  const auto reader = bus->reader(topics::tool_state);
  ASSERT_TRUE(take_within(*reader));
  ASSERT_TRUE(eventually([&] { return reader->writers() == 1; }));
  std::vector<double> seconds;
  for (int round = 0; round < 3; ++round) {
    const std::int64_t killed = now_ns();
    first->end(SIGKILL);
    ASSERT_TRUE(eventually([&] { return reader->writers() == 0; }, 5s));
    seconds.push_back(1e-9 * static_cast<double>(now_ns() - killed));
    while (reader->take()) {
    }
    first = std::make_unique<Peer>("publish", domain);
    const auto again = take_within(*reader);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->run, first->run());
    ASSERT_TRUE(eventually([&] { return reader->writers() == 1; }));
  }
  std::sort(seconds.begin(), seconds.end());
  RecordProperty("death_noticed_s", std::to_string(seconds[1]));
  EXPECT_LT(seconds[1], 1.0);
}

TEST_F(TwoProcesses, AStoppedWriterIsMissedAndWelcomedBack) {
  Peer peer("publish", domain);
  const auto reader = bus->reader(topics::tool_state);
  ASSERT_TRUE(take_within(*reader));
  ASSERT_TRUE(eventually([&] { return reader->writers() == 1; }));
  peer.send(SIGSTOP);
  EXPECT_TRUE(eventually([&] { return reader->writers() == 0; }));
  peer.send(SIGCONT);
  EXPECT_TRUE(eventually([&] { return reader->writers() == 1; }));
}

TEST_F(TwoProcesses, AReaderThatStopsNeverStallsTheWriter) {
  Peer lazy("collect", domain);
  const auto tool = bus->writer(topics::tool_state);
  const auto contact = bus->writer(topics::contact_state);
  ASSERT_TRUE(eventually([&] { return tool->readers() == 1 && contact->readers() == 1; }));
  std::this_thread::sleep_for(100ms);
  lazy.send(SIGSTOP);
  Histogram cost;
  ContactState message = contact_sample(16);
  PeriodicTimer timer(2000);
  for (std::uint64_t seq = 1; seq <= 5000; ++seq) {
    timer.wait();
    const std::int64_t begin = now_ns();
    ASSERT_TRUE(tool->write(tool_sample(seq)));
    message.seq = seq;
    ASSERT_TRUE(contact->write(message));
    cost.record(now_ns() - begin);
  }
  RecordProperty("write_p99_us", std::to_string(percentiles_us(cost).p99));
  EXPECT_LT(percentiles_us(cost).p50, 500);
  EXPECT_LT(percentiles_us(cost).p99, 20'000);
}

TEST_F(TwoProcesses, SamplesWithoutFiniteNumbersAreDroppedAndCounted) {
  Peer peer("nonsense", domain);
  const auto reader = bus->reader(topics::tool_state, Keep::all);
  for (int i = 0; i < 10; ++i) {
    const auto message = take_within(*reader);
    ASSERT_TRUE(message);
    EXPECT_EQ(message->depth, 0.25);
    EXPECT_EQ(message->seq % 2, 0u);
  }
  EXPECT_GE(reader->invalid(), 9u);
}

TEST_F(TwoProcesses, ARecorderThatJoinsARunningSystemLosesNothingAndHasItsScene) {
  const auto file =
      std::filesystem::temp_directory_path() / ("palpate_recorder_" + std::to_string(getpid()) + ".lcmlog");
  Peer peer("publish", domain);
  const auto tool = bus->reader(topics::tool_state);
  ASSERT_TRUE(take_within(*tool));
  const std::vector<std::string> written{"palpate/tool_state",   "palpate/contact_state", "palpate/force_state",
                                         "palpate/node_status",  "palpate/surface_state", "palpate/scene",
                                         "palpate/held_contacts"};
  const auto all = [&](RecorderReport so_far) {
    return std::ranges::all_of(written, [&](const std::string& name) { return so_far.topics[name].samples > 0; }) &&
           so_far.topics["palpate/tool_state"].samples > kMany;
  };
  RecorderReport report;
  {
    const auto recorder_bus = make_dds_bus({.domain = domain});
    Recorder recorder(*recorder_bus, {.file = file, .version = "0.1.0"});
    EXPECT_TRUE(eventually([&] { return recorder.step(20ms), all(recorder.report()); }, 20s));
    report = recorder.finish();
  }
  EXPECT_TRUE(report.has_scene);
  EXPECT_EQ(report.missing(), 0u);
  EXPECT_EQ(report.log.lost, 0u);
  for (const std::string& name : written) EXPECT_GT(report.topics[name].samples, 0u) << name;
  EXPECT_GT(report.topics["palpate/tool_state"].samples, kMany);

  LogReader log(file);
  LogEvent event;
  ToolState sample;
  std::uint64_t count = 0, last = 0;
  while (log.next(event)) {
    if (!event.read(topics::tool_state, sample)) continue;
    if (last > 0) {
      ASSERT_EQ(sample.seq, last + 1);
    }
    last = sample.seq;
    ++count;
  }
  EXPECT_EQ(count, report.topics["palpate/tool_state"].samples);
  EXPECT_EQ(log.header().scene, scene_sample().text);
  EXPECT_EQ(log.header().code_path, scene_sample().code_path);
  EXPECT_TRUE(log.damage().empty());
  EXPECT_TRUE(log.footer());
  std::filesystem::remove(file);
}

TEST(DdsSettings, NonsenseIsRefusedInWords) {
  const auto message = [](const BusSettings& settings) {
    try {
      make_dds_bus(settings);
      return std::string("accepted");
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(message({.domain = 231}), "network: domain 231 is outside 0..230");
  EXPECT_EQ(message({.domain = -1}), "network: domain -1 is outside 0..230");
  EXPECT_EQ(message({.domain = 1, .interface = "nonexistent0"}),
            "network: this host has no interface 'nonexistent0' with an IPv4 address");
  EXPECT_EQ(message({.domain = 1, .interface = "203.0.113.7"}),
            "network: no interface of this host has the address 203.0.113.7");
  EXPECT_EQ(message({.domain = 1, .interface = "", .peers = {"a\"/><x"}}),
            "network: 'a\"/><x' is not a name or address of a peer");
}

TEST(DdsSettings, ARealInterfaceGetsDatagramsThatFitAFrame) {
  const std::string loopback = dds_configuration({.domain = 1});
  const std::string network = dds_configuration({.domain = 1, .interface = "lo", .peers = {"192.0.2.1"}});
  EXPECT_EQ(loopback.find("MaxMessageSize"), std::string::npos);
  EXPECT_NE(network.find("<MaxMessageSize>1400B</MaxMessageSize>"), std::string::npos);
  EXPECT_NE(network.find("<Peer address=\"192.0.2.1\"/>"), std::string::npos);
  EXPECT_NE(network.find("<AllowMulticast>false</AllowMulticast>"), std::string::npos);
  EXPECT_NO_THROW(make_dds_bus({.domain = own_domain() + 100, .interface = "lo", .peers = {"192.0.2.1"}}));
}

}  // namespace
}  // namespace palpate
