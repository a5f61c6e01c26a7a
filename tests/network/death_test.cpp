#include <csignal>

#include "tests/network/network_test.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

/// The tool comes to rest deep in the block, so that every run ends in the same state.
struct RestingScene : NetworkScene {
  explicit RestingScene(const std::string& name) : NetworkScene(name) {
    write("motion.csv",
          "time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n0.5,0,0,0.197,0,0\n0.8,0.05,0.02,0.197,0,0\n600,0.05,0.02,0."
          "197,0,0\n");
  }
};
constexpr std::uint64_t kAtRest = 1000;  ///< a step after that

class Death : public NodesTest<RestingScene, TwoHosts::Link::veth> {
 protected:
  using Node = std::unique_ptr<ChildProcess>;
  using Span = std::chrono::milliseconds;

  void SetUp() override {
    NodesTest::SetUp();
    if (!hosts_ || HasFatalFailure()) return;
    start_deform();
    start_render();
    start_haptic();
    ASSERT_TRUE(settled());
    undisturbed_ = observer_->surface.position;
    force_ = observer_->force.force[2];
    ASSERT_GT(force_, 0.1);
  }
  void TearDown() override {
    EXPECT_TRUE(!observer_ || observer_->finite);
    NodesTest::TearDown();
  }

  /// How often each node dies, and for how long it has lived then: from its first moments to its steady state.
  static int deaths() { return long_tests() ? 10 : 2; }
  static Span life(int death) { return Span(long_tests() ? 20 + 150 * death : 30 + 500 * death); }

  void start_deform() { deform_ = std::make_unique<ChildProcess>(nodes_->on_b("deform_node")); }
  void start_render() { render_ = std::make_unique<ChildProcess>(nodes_->on_a("render_node")); }
  void start_haptic() { haptic_ = std::make_unique<ChildProcess>(nodes_->on_a("haptic_node")); }
  static void kill_now(const Node& node) {
    kill(node->pid(), SIGKILL);
    EXPECT_TRUE(node->wait(5s));
  }

  /// A surface of the running haptic node has come that shows its tool at rest.
  bool settled() {
    return observer_->listen(20s, [&] {
      return observer_->surface.run != 0 && observer_->surface.run == observer_->tool.run &&
             observer_->surface.step > kAtRest;
    });
  }
  bool comes_after(const Observer::Frames& frames, std::int64_t moment) {
    return observer_->listen(20s, [&] { return first_since(frames, moment) != 0; });
  }
  /// Largest difference [m] between what is shown and the surface of an undisturbed run.
  double error() const {
    const std::vector<float>& now = observer_->surface.position;
    if (now.size() != undisturbed_.size()) return 1;
    double largest = 0;
    for (std::size_t i = 0; i < now.size(); ++i)
      largest = std::max<double>(largest, std::abs(now[i] - undisturbed_[i]));
    return largest;
  }

  Node deform_, render_, haptic_;
  std::vector<float> undisturbed_;
  double force_ = 0;  ///< [N] of an undisturbed run
};

TEST_F(Death, OfAnyNodeAtAnyMomentIsFollowedByTheUndisturbedState) {
  for (int i = 0; i < deaths(); ++i) {
    kill_now(deform_);
    start_deform();
    observer_->listen(life(i));
    kill_now(deform_);
    start_deform();
    EXPECT_TRUE(comes_after(observer_->surfaces, now_ns())) << "deformation node, death " << i;
    EXPECT_LT(error(), 1e-6) << "deformation node, death " << i;
  }
  for (int i = 0; i < deaths(); ++i) {
    kill_now(render_);
    start_render();
    observer_->listen(life(i));
    kill_now(render_);
    start_render();
    EXPECT_TRUE(comes_after(observer_->pictures, now_ns())) << "render node, death " << i;
  }
  for (int i = 0; i < deaths(); ++i) {
    const std::uint64_t gone = observer_->tool.run;
    kill_now(haptic_);
    start_haptic();
    EXPECT_TRUE(observer_->listen(20s, [&] { return observer_->tool.run != gone; })) << "haptic node, death " << i;
    observer_->listen(life(i));
  }
  ASSERT_TRUE(settled());
  EXPECT_LT(error(), 1e-6);
  EXPECT_NEAR(observer_->force.force[2], force_, 1e-6 * force_);
}

TEST_F(Death, ANodeThatIsStoppedAndGoesOnDoesNotJumpTheForce) {
  for (const Node* node : {&deform_, &render_, &haptic_}) {
    observer_->max_jump = 0;
    kill((*node)->pid(), SIGSTOP);
    observer_->listen(400ms);
    const std::int64_t goes_on = now_ns();
    kill((*node)->pid(), SIGCONT);
    EXPECT_TRUE(comes_after(observer_->surfaces, goes_on)) << (*node)->name();
    EXPECT_TRUE(comes_after(observer_->pictures, goes_on)) << (*node)->name();
    EXPECT_LT(observer_->max_jump, 0.01 * force_) << (*node)->name();
    EXPECT_NEAR(observer_->force.force[2], force_, 0.01 * force_) << (*node)->name();
    EXPECT_LT(error(), 1e-5) << (*node)->name();
  }
}

}  // namespace
}  // namespace palpate::testing
