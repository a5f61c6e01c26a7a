#include <nlohmann/json.hpp>
#include <set>

#include "common/node/topology_feed.hpp"
#include "common/scene/find_archive.hpp"
#include "common/scene/scene.hpp"
#include "tests/network/network_test.hpp"
#include "tests/sanitized.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

using CutOverRelay = NodesTest<LongCutScene, TwoHosts::Link::relay>;

/// The changes are numbered from 1 without gaps, and nothing is removed twice; all that is gone.
std::set<std::uint32_t> in_order(const std::vector<TopologyChange>& changes) {
  std::set<std::uint32_t> gone;
  std::uint64_t seq = 0;
  for (const TopologyChange& change : changes) {
    EXPECT_EQ(change.seq, ++seq);
    EXPECT_EQ(change.run, changes[0].run);
    for (const std::uint32_t t : change.removed) EXPECT_TRUE(gone.insert(t).second) << "tetrahedron " << t;
  }
  return gone;
}

/// What a node that comes late makes of the changes.
class LateNode {
 public:
  LateNode(const TwoHosts& hosts, const LoopbackScene& scene) {
    const Inside here(hosts.a());
    const Scene loaded = load_scene(scene.scene());
    archives_.push_back(find_archive(loaded, loaded.bodies[0], ArchivePart::header));
    bus_ = make_dds_bus({.domain = Nodes::kDomain, .interface = TwoHosts::device, .peers = {TwoHosts::address_b}});
    presence_ = std::make_unique<Presence>(*bus_, "render", 0, scene_hash(loaded), archives_[0].content_hash);
    feed_ = std::make_unique<TopologyFeed>(*bus_, *presence_, archives_);
  }
  bool has_lost(std::size_t count, std::chrono::milliseconds limit) {
    for (const auto end = std::chrono::steady_clock::now() + limit; std::chrono::steady_clock::now() < end;
         bus_->wait(10ms)) {
      presence_->watch();
      feed_->take();
      if (feed_->cuts() == count) return true;
    }
    return false;
  }
  const CutMesh& mesh() const { return feed_->mesh(0); }

 private:
  std::vector<Archive> archives_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Presence> presence_;
  std::unique_ptr<TopologyFeed> feed_;
};

TEST_F(CutOverRelay, EveryChangeArrivesInOrderThroughLossAndACut) {
  hosts_->impair("both delay 0.03 jitter 0.02 loss 0.2 duplicate 0.1 reorder 0.1");
  ChildProcess deform = nodes_->on_b("deform_node", {"--supervised"});
  ChildProcess haptic = nodes_->on_a("haptic_node");
  ASSERT_TRUE(observer_->listen(30s, [&] { return !observer_->changes.empty(); }));
  hosts_->impair("both cut 1");
  observer_->listen(700ms);
  hosts_->impair("both cut 0");
  // A slow tissue begins when the scalpel is on its way.
  const std::size_t enough = kSanitized ? 10 : 30;
  EXPECT_TRUE(observer_->listen(30s, [&] { return in_order(observer_->changes).size() > enough; }));
  wait_until_whole_cut();
  haptic.interrupt();
  ASSERT_TRUE(haptic.wait(20s));
  wait_until_whole_cut();  // by what it had sent

  const std::set<std::uint32_t> gone = in_order(observer_->changes);
  LateNode late(*hosts_, scene_);
  ASSERT_TRUE(late.has_lost(gone.size(), 20s)) << "who comes late gets every change";
  for (int t = 0; t < late.mesh().size(); ++t)
    ASSERT_EQ(late.mesh().alive(t), !gone.contains(static_cast<std::uint32_t>(t))) << t;

  deform.interrupt();
  ASSERT_TRUE(deform.wait(20s)) << "a writer lingers for what a bad link has not acknowledged";
  const auto summary = nlohmann::json::parse(deform.take_lines().back());
  EXPECT_EQ(gone.size(), summary["tetrahedra_cut"].get<std::size_t>() + summary["tetrahedra_torn"].get<std::size_t>() +
                             summary["tetrahedra_fallen"].get<std::size_t>())
      << "all that the deformation node removed has arrived";
  EXPECT_TRUE(observer_->finite);
}

}  // namespace
}  // namespace palpate::testing
