#include "common/bus/log_reader.hpp"
#include "common/bus/sequence.hpp"
#include "tests/network/network_test.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

using OverVeth = NodesTest<NetworkScene, TwoHosts::Link::veth>;

TEST_F(OverVeth, AllNodesJoinAndTheSurfaceFollowsTheTool) {
  ChildProcess deform = nodes_->on_b("deform_node");
  ChildProcess recorder = nodes_->recorder_on_b("far.lcmlog");
  ChildProcess render = nodes_->on_a("render_node");
  ChildProcess haptic = nodes_->on_a("haptic_node");
  ASSERT_TRUE(joined());
  const std::int64_t begin = now_ns();
  const std::uint64_t first = observer_->tool.step;
  observer_->listen(1s);
  EXPECT_GT(observer_->tool.step, first + 500);
  EXPECT_EQ(observer_->forces.missing(), 0u);
  const auto shown = ages(observer_->surfaces, begin);
  EXPECT_GT(shown.size(), 30u);
  RecordProperty("age_p50_ms", fmt::format("{:.2f}", 1e3 * at_share(shown, 0.5)));
  RecordProperty("age_p99_ms", fmt::format("{:.2f}", 1e3 * at_share(shown, 0.99)));
  RecordProperty("frames", std::to_string(shown.size()));
  EXPECT_LT(at_share(shown, 0.5), 0.1);
  EXPECT_TRUE(observer_->listen(20s, [&] { return first_since(observer_->pictures, begin) != 0; }))
      << "the picture follows";

  haptic.interrupt();
  ASSERT_TRUE(haptic.wait(5s));
  EXPECT_EQ(haptic.status(), 0);
  recorder.interrupt();
  ASSERT_TRUE(recorder.wait(5s));
  EXPECT_EQ(recorder.status(), 0);
  LogReader log(scene_.folder() / "far.lcmlog");
  LogEvent event;
  ForceState force;
  SequenceCheck forces;
  while (log.next(event))
    if (event.read(topics::force_state, force)) forces.add(force);
  EXPECT_EQ(forces.streams(), 1u);
  EXPECT_EQ(forces.missing(), 0u) << "the recorder on the other host has every step";
  EXPECT_FALSE(log.header().scene.empty());

  hosts_->a().ip(fmt::format("link delete {}", TwoHosts::device));
  deform.interrupt();
  render.interrupt();
  EXPECT_TRUE(deform.wait(5s)) << "a node ends also when its interface is gone";
  EXPECT_TRUE(render.wait(5s));
}

TEST_F(OverVeth, ANodeSaysWhereItListensAndWhomItRefuses) {
  ChildProcess deform = nodes_->on_b("deform_node");
  const NetworkScene other("other", 9000);
  precompute(other);
  const auto says = [&](const char* name, const std::string& words) {
    return nodes_->said(name).find(words) != std::string::npos;
  };
  EXPECT_TRUE(observer_->listen(20s, [&] { return says("deform_node", "alone for 5 s"); }));
  EXPECT_TRUE(says("deform_node", "listening in domain 3 on link0 (10.77.0.2), UDP ports from 8150, asking 10.77.0.1"))
      << nodes_->said("deform_node");

  const Nodes stranger(*hosts_, other);
  ChildProcess haptic = stranger.on_a("haptic_node");
  EXPECT_TRUE(observer_->listen(10s, [&] { return says("deform_node", "refusing haptic"); }));
  EXPECT_TRUE(says("deform_node", "it runs another scene"));
  EXPECT_TRUE(observer_->listen(
      10s, [&] { return stranger.said("haptic_node").find("refusing deform") != std::string::npos; }));
  observer_->listen(500ms);
  EXPECT_EQ(observer_->surface.run, 0u) << "nothing of the other scene is shown";
}

}  // namespace
}  // namespace palpate::testing
