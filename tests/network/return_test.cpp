// A deformation node that dies does not heal what was cut.
#include <algorithm>
#include <csignal>
#include <set>

#include "tests/network/network_test.hpp"
#include "tests/sanitized.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

class Return : public NodesTest<LongCutScene, TwoHosts::Link::veth> {
 protected:
  using Gone = std::set<std::uint32_t>;

  /// What the deformation node that spoke last has removed, by its numbered changes.
  Gone gone() const {
    Gone all;
    if (observer_->changes.empty()) return all;
    const std::uint64_t run = observer_->changes.back().run;
    std::uint64_t seq = 0;
    for (const TopologyChange& change : observer_->changes) {
      if (change.run != run) continue;
      EXPECT_EQ(change.seq, ++seq);
      for (const std::uint32_t t : change.removed)
        EXPECT_TRUE(all.insert(t).second) << "tetrahedron " << t << " of run " << run;
    }
    return all;
  }
  std::uint64_t last_run() const { return observer_->changes.empty() ? 0 : observer_->changes.back().run; }
  /// Another deformation node than that of this run has begun.
  bool begins_after(std::uint64_t run) {
    return observer_->listen(20s, [&] { return last_run() != run; });
  }
};

bool contains(const std::set<std::uint32_t>& all, const std::set<std::uint32_t>& some) {
  return std::ranges::includes(all, some);
}

TEST_F(Return, OfADeformationNodeThatDiedWhileItCutKeepsWhatWasCut) {
  auto deform = std::make_unique<ChildProcess>(nodes_->on_b("deform_node"));
  ChildProcess haptic = nodes_->on_a("haptic_node");
  ASSERT_TRUE(observer_->listen(20s, [&] { return gone().size() > 5; }));
  const int deaths = long_tests() ? 10 : 3;
  for (int i = 0; i < deaths; ++i) {
    observer_->listen(std::chrono::milliseconds(100 + 37 * i));  // the haptic node has heard of what was cut before
    const Gone before = gone();
    const std::uint64_t run = last_run();
    kill(deform->pid(), SIGKILL);
    ASSERT_TRUE(deform->wait(5s));
    deform = std::make_unique<ChildProcess>(nodes_->on_b("deform_node"));
    ASSERT_TRUE(begins_after(run)) << "death " << i;
    EXPECT_TRUE(contains(gone(), before))
        << "death " << i << ": " << before.size() << " were gone, " << gone().size() << " are";
  }
  EXPECT_TRUE(observer_->listen(20s, [&] { return gone().size() > (kSanitized ? 5u : 20u); }))
      << "a slow tissue is cut less: " << gone().size();
  wait_until_whole_cut();
  const Gone end = gone();

  // Both hosts' other nodes die as well, one after the other: somebody always remembers.
  ChildProcess render = nodes_->on_a("render_node");
  ASSERT_TRUE(observer_->listen(20s, [&] { return !observer_->pictures.empty(); }));
  observer_->listen(500ms);
  kill(haptic.pid(), SIGKILL);
  kill(deform->pid(), SIGKILL);
  ASSERT_TRUE(haptic.wait(5s));
  ASSERT_TRUE(deform->wait(5s));
  const std::uint64_t run = last_run();
  const std::size_t said = nodes_->said("deform_node").size();
  deform = std::make_unique<ChildProcess>(nodes_->on_b("deform_node"));
  // It asks those that it knows when it hears of a tool: on a busy machine the render node may be met later.
  ASSERT_TRUE(observer_->listen(
      20s, [&] { return nodes_->said("deform_node").find("met render", said) != std::string::npos; }));
  ChildProcess haptic_again = nodes_->on_a("haptic_node");
  ASSERT_TRUE(begins_after(run));
  EXPECT_TRUE(contains(gone(), end));
  EXPECT_NE(nodes_->said("deform_node").find("tetrahedra had gone before, by"), std::string::npos);

  // Who wants a new organ says so.
  const std::uint64_t last = last_run();
  deform->interrupt();
  ASSERT_TRUE(deform->wait(5s));
  deform = std::make_unique<ChildProcess>(nodes_->on_b("deform_node", {"--whole"}));
  ASSERT_TRUE(begins_after(last));
  const auto first = std::ranges::find(observer_->changes, last_run(), &TopologyChange::run);
  EXPECT_TRUE(first->removed.empty());
}

}  // namespace
}  // namespace palpate::testing
