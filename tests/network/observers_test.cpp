// The short form of bench/observers.cpp.
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/bus/domain.hpp"
#include "tests/network/network_test.hpp"
#include "tests/network/program_lines.hpp"
#include "tests/sanitized.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

class Observed : public NodesTest<NetworkScene, TwoHosts::Link::veth> {
 protected:
  /// A listener or recorder on host B.
  ChildProcess watcher(const std::string& command) const {
    const Inside here(hosts_->b());
    return start("watcher", fmt::format("{} --domain {} --interface {} --peer {}", command, Nodes::kDomain,
                                        TwoHosts::device, TwoHosts::address_a));
  }
  static json end(ChildProcess& process) {
    process.interrupt();
    EXPECT_TRUE(process.wait(10s));
    EXPECT_EQ(process.status(), 0);
    return last_line(process);
  }
};

TEST_F(Observed, ObserversAndARecorderHearEverySampleWhileOneDraws) {
  ChildProcess deform = nodes_->on_b("deform_node");
  ChildProcess render = nodes_->on_b("render_node");
  ChildProcess listener = watcher(program("listener"));
  ChildProcess recorder = watcher(program("palpate") + " record --supervised --keep everything -o " +
                                  (scene_.folder() / "observed.lcmlog").string());
  ASSERT_TRUE(says_ready(listener));
  ASSERT_TRUE(says_ready(recorder));
  std::this_thread::sleep_for(500ms);
  ChildProcess haptic = nodes_->on_a("haptic_node", {"--seconds", "3", "--supervised"});
  ASSERT_TRUE(haptic.wait(20s));
  std::this_thread::sleep_for(200ms);

  const json summary = last_line(haptic);
  const auto ticks = summary["ticks"].get<std::uint64_t>();
  EXPECT_GT(ticks, 1000u);
  EXPECT_GT(summary["ring_to_wire_us_p50"].get<double>(), 0);
  const json heard = end(listener);
  EXPECT_EQ(heard["missing"], 0) << heard;
  for (const char* topic : {"palpate/tool_state", "palpate/force_state"})
    EXPECT_EQ(heard["topics"][topic]["samples"], ticks) << topic;
  EXPECT_GT(heard["topics"]["palpate/surface_state"]["samples"], 50) << heard;
  EXPECT_GT(heard["topics"]["palpate/picture_state"]["samples"], 5) << heard;
  const json recorded = end(recorder);
  EXPECT_EQ(recorded["missing"], 0) << recorded;
  EXPECT_EQ(recorded["lost"], 0) << recorded;
  EXPECT_GE(recorded["messages"].get<std::uint64_t>(), 2 * ticks) << recorded;
}

/// A publisher of all topics on host A, and listeners on host B.
class Listened : public ::testing::Test {
 protected:
  static constexpr int kRateHz = kSanitized ? 50 : 200;

  void SetUp() override {
    PALPATE_TWO_HOSTS_OR_SKIP(hosts_, TwoHosts::Link::veth)
    for (const NetworkNamespace* host : {&hosts_->a(), &hosts_->b()}) {
      host->ip(fmt::format("link set {} multicast on", TwoHosts::device));
      host->ip(fmt::format("route add 224.0.0.0/4 dev {}", TwoHosts::device));
    }
  }
  /// That have left host A so far.
  double datagrams() const {
    const Inside here(hosts_->a());
    std::ifstream devices("/proc/thread-self/net/dev");
    std::string word;
    while (devices >> word && word != std::string(TwoHosts::device) + ":") continue;
    double value = 0;
    for (int i = 0; i < 10; ++i) devices >> value;  // the tenth figure is that of packets sent
    return value;
  }
  /// Datagrams that a second of publishing takes. Each listener has to hear all.
  double datagrams_for(int listeners, bool multicast) const {
    std::vector<ChildProcess> all;
    for (int i = 0; i < listeners; ++i) {
      const Inside here(hosts_->b());
      const std::string peer = multicast ? "" : fmt::format("--peer {}", TwoHosts::address_a);
      all.push_back(start("listener", fmt::format("{} --domain {} --interface {} {}", program("listener"), own_domain(),
                                                  TwoHosts::device, peer)));
    }
    for (ChildProcess& listener : all) EXPECT_TRUE(says_ready(listener));
    std::this_thread::sleep_for(200ms);
    const double before = datagrams();
    {
      const Inside here(hosts_->a());
      ChildProcess writing =
          start("full_rate", fmt::format("{} {} 1 {} {} {} {}", program("full_rate"), kRateHz, listeners, own_domain(),
                                         TwoHosts::device, multicast ? "" : TwoHosts::address_b));
      EXPECT_TRUE(writing.wait(40s));
      EXPECT_EQ(writing.status(), 0) << last_line(writing);
    }
    const double sent = datagrams() - before;
    for (ChildProcess& listener : all) {
      listener.interrupt();
      EXPECT_TRUE(listener.wait(10s));
      const json heard = last_line(listener);
      EXPECT_EQ(heard["missing"], 0) << heard;
      EXPECT_EQ(heard["topics"].size(), std::tuple_size_v<decltype(topics::all)>) << heard;
      EXPECT_EQ(heard["messages"], kRateHz * std::tuple_size_v<decltype(topics::all)>) << heard;
    }
    return sent;
  }

  std::unique_ptr<TwoHosts> hosts_;
};

TEST_F(Listened, WithMulticastOneDatagramServesAllListeners) {
  const double one = datagrams_for(1, true), four = datagrams_for(4, true), one_by_one = datagrams_for(4, false);
  fmt::print("datagrams by multicast for 1 listener: {:.0f}, for 4: {:.0f}; to 4 peers: {:.0f}\n", one, four,
             one_by_one);
  EXPECT_GT(one, kRateHz * 20);
  EXPECT_LT(four, 1.5 * one);
  EXPECT_GT(one_by_one, 2.5 * one);
}

}  // namespace
}  // namespace palpate::testing
