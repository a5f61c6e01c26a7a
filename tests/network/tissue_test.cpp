// Moving tissue lives in the deformation node, so that its force crosses the link.
#include <csignal>

#include "tests/network/network_test.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

/// The tool rests deep in moving tissue.
struct TissueScene : CutScene {
  explicit TissueScene(const std::string& name) : CutScene(name) {
    replace("\ncautery = { radius = 0.009 }", "");
    write("motion.csv",
          "time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n0.5,0,0,0.197,0,0\n0.8,0.05,0.02,0.197,0,0\n600,0.05,0.02,0."
          "197,0,0\n");
  }
};

class TissueOverRelay : public NodesTest<TissueScene, TwoHosts::Link::relay> {
 protected:
  bool stale() const { return (observer_->force.flags & stale_model) != 0; }
  /// Surface nodes [m] before any tool has come.
  std::vector<float> surface_at_rest() {
    observer_->listen(20s, [&] { return !observer_->surface.position.empty(); });
    return observer_->surface.position;
  }
  /// Largest distance [m] of what is shown now from that.
  double deepest(const std::vector<float>& rest) const {
    double largest = 0;
    for (std::size_t i = 0; i < rest.size(); ++i)
      largest = std::max<double>(largest, std::abs(observer_->surface.position[i] - rest[i]));
    return largest;
  }
  bool fresh_within(std::chrono::milliseconds limit) {
    return observer_->listen(limit, [&] { return !stale() && observer_->force.force[2] > 0; });
  }
};

TEST_F(TissueOverRelay, ItsForceFadesInACutAndComesBackWithoutAJump) {
  ChildProcess deform = nodes_->on_b("deform_node");
  ChildProcess haptic = nodes_->on_a("haptic_node");
  ASSERT_TRUE(joined());
  observer_->listen(1500ms);
  const double force = observer_->force.force[2];
  ASSERT_GT(force, 0.1);

  observer_->max_jump = 0;
  hosts_->impair("both cut 1");
  EXPECT_TRUE(observer_->listen(2s, [&] { return stale() && observer_->force.force[2] == 0; }))
      << "nothing is felt that nobody computes";
  observer_->listen(1500ms);
  hosts_->impair("both cut 0");
  const std::int64_t back = now_ns();
  EXPECT_TRUE(fresh_within(5s));
  fmt::print("force back after {:.1f} ms\n", 1e-6 * static_cast<double>(now_ns() - back));
  double largest = 0;
  observer_->listen(300ms, [&] {
    largest = std::max(largest, observer_->force.force[2]);
    return false;
  });
  EXPECT_LT(largest, 1.05 * force) << "the tissue was held meanwhile: nothing strikes the tool";
  EXPECT_NEAR(observer_->force.force[2], force, 0.02 * force);
  EXPECT_LT(observer_->max_jump, 0.05 * force) << "no step that a hand would feel";

  // The models of the newest steps get through without repair.
  hosts_->impair("both loss 0.3");
  observer_->listen(300ms);
  int stale_steps = 0;
  for (int i = 0; i < 20; ++i) {
    observer_->listen(50ms);
    stale_steps += stale();
  }
  EXPECT_LE(stale_steps, 5);
  hosts_->impair("both clear");
  EXPECT_TRUE(fresh_within(5s));
  observer_->listen(500ms);

  const double before = observer_->force.force[2];
  observer_->max_jump = 0;
  kill(deform.pid(), SIGSTOP);
  EXPECT_TRUE(observer_->listen(2s, [&] { return stale() && observer_->force.force[2] == 0; }));
  kill(deform.pid(), SIGCONT);
  EXPECT_TRUE(fresh_within(5s));
  observer_->listen(500ms);
  EXPECT_NEAR(observer_->force.force[2], before, 0.1 * before);
  EXPECT_LT(observer_->max_jump, 0.05 * before) << "it fades over many steps";
  EXPECT_TRUE(observer_->finite);
  EXPECT_GE(observer_->min_energy, -0.01);
}

TEST_F(TissueOverRelay, IsLetGoWhenTheHapticNodeEndsAndNotWhileItIsStopped) {
  ChildProcess deform = nodes_->on_b("deform_node");
  ChildProcess recorder = nodes_->recorder_on_b("left.lcmlog");
  ChildProcess haptic = nodes_->on_a("haptic_node");
  const std::vector<float> rest = surface_at_rest();
  ASSERT_TRUE(joined());
  observer_->listen(1500ms);
  const double force = observer_->force.force[2], depth = deepest(rest);
  ASSERT_GT(force, 0.1);
  ASSERT_GT(depth, 0.001);

  kill(haptic.pid(), SIGSTOP);
  observer_->listen(2s);
  EXPECT_NEAR(deepest(rest), depth, 0.01 * depth) << "its tool is where it was";
  observer_->max_jump = 0;
  kill(haptic.pid(), SIGCONT);
  observer_->listen(1s);
  // Where the machine stands for a moment the force fades and comes back: it is felt again, and without a jump.
  observer_->listen(5s, [&] { return std::abs(observer_->force.force[2] - force) < 0.02 * force; });
  EXPECT_NEAR(observer_->force.force[2], force, 0.02 * force);
  EXPECT_LT(observer_->max_jump, 0.05 * force);

  haptic.interrupt();
  ASSERT_TRUE(haptic.wait(5s));
  EXPECT_TRUE(observer_->listen(5s, [&] { return deepest(rest) < 0.1 * depth; })) << deepest(rest) << " of " << depth;
  deform.interrupt();
  ASSERT_TRUE(deform.wait(5s));
  recorder.interrupt();
  ASSERT_TRUE(recorder.wait(5s));
  std::string output;
  EXPECT_EQ(
      run_command(program("palpate") + " replay " + (scene_.folder() / "left.lcmlog").string() + " --verify", &output),
      0)
      << output;
  EXPECT_NE(output.find("ticks of the tissue end in the recorded state, bit for bit"), std::string::npos) << output;
}

}  // namespace
}  // namespace palpate::testing
