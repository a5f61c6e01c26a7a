// The short form of bench/observers.cpp.
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/network/network_test.hpp"
#include "tests/network/program_lines.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

class Observed : public NodesTest<NetworkScene, TwoHosts::Link::veth> {
 protected:
  /// A listener or recorder on host B.
  ChildProcess watcher(const std::string& command) const {
    const Inside here(hosts_->b());
    return start("watcher", fmt::format("{} --domain {} --interface {} --peer {}", command, Nodes::domain, TwoHosts::device, TwoHosts::address_a));
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
  ChildProcess recorder = watcher(program("palpate") + " record --supervised -o " + (scene_.folder() / "observed.lcmlog").string());
  ASSERT_TRUE(says_ready(listener));
  ASSERT_TRUE(says_ready(recorder));
  std::this_thread::sleep_for(500ms);
  ChildProcess haptic = nodes_->on_a("haptic_node", {"--seconds", "3", "--supervised"});
  ASSERT_TRUE(haptic.wait(20s));
  std::this_thread::sleep_for(200ms);

  const json summary = last_line(haptic);
  const auto ticks = summary["ticks"].get<std::uint64_t>();
  EXPECT_GT(ticks, 2000u);
  EXPECT_GT(summary["ring_to_wire_us_p50"].get<double>(), 0);
  const json heard = end(listener);
  EXPECT_EQ(heard["missing"], 0) << heard;
  for (const char* topic : {"palpate/tool_state", "palpate/force_state"}) EXPECT_EQ(heard["topics"][topic]["samples"], ticks) << topic;
  EXPECT_GT(heard["topics"]["palpate/surface_state"]["samples"], 50) << heard;
  EXPECT_GT(heard["topics"]["palpate/picture_state"]["samples"], 5) << heard;
  const json recorded = end(recorder);
  EXPECT_EQ(recorded["missing"], 0) << recorded;
  EXPECT_EQ(recorded["lost"], 0) << recorded;
  EXPECT_GE(recorded["messages"].get<std::uint64_t>(), 2 * ticks) << recorded;
}

}  // namespace
}  // namespace palpate::testing
