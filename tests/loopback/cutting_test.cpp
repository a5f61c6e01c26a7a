#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "common/bus/dds_bus.hpp"
#include "common/bus/log_reader.hpp"
#include "common/node/topology_feed.hpp"
#include "common/scene/find_archive.hpp"
#include "common/scene/scene.hpp"
#include "tests/bus/domain.hpp"
#include "tests/loopback/loopback_scene.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using testing::LoopbackScene;
using testing::own_domain;
using testing::program;
using testing::run_command;

/// The block as moving tissue under a scalpel that goes through its middle with the pedal down; half of it is marked to
/// be cut off.
struct CuttingScene : LoopbackScene {
  CuttingScene() : LoopbackScene("cutting", "[body.dynamic]\ndamping = 20\nresect = [[0, -1, -1], [1, 1, 1]]\n") {
    replace("quasi_static", "tensor_mass");
    replace("radius = 0.008", "radius = 0.008\ncautery = { radius = 0.009 }");
    write("motion.csv",
          "time,yaw,pitch,depth,roll,grip,pedal\n0,0.3,0,0.17,0,0,0\n0.3,0.3,0,0.21,0,0,1\n2.0,-0.3,0,0.21,0,0,1\n2.3,-"
          "0.3,0,0.17,0,0,0\n3.5,0,0,0.17,0,0,0\n");
  }
};

/// Tetrahedra gone by a log, and those of them that the tool has cut.
struct Removed {
  std::set<std::uint32_t> all, cut;
};
Removed removed_in(const std::filesystem::path& file) {
  LogReader log(file);
  LogEvent event;
  TopologyChange change;
  Removed gone;
  while (log.next(event)) {
    if (!event.read(topics::topology_change, change)) continue;
    gone.all.insert(change.removed.begin(), change.removed.end());
    if (change.cause == RemovalCause::cut) gone.cut.insert(change.removed.begin(), change.removed.end());
  }
  return gone;
}

TEST(CuttingTest, EveryNodeEndsWithTheSameTissueAndTheLogProvesIt) {
  const CuttingScene scene;
  const std::string log = scene.folder() / "cut.lcmlog";
  std::string output;
  ASSERT_EQ(run_command(program("palpate") + " precompute " + scene.scene(), &output), 0) << output;

  ChildProcess run("run",
                   {program("palpate"), "run", scene.scene(), "--domain", std::to_string(own_domain()), "--record", log,
                    "--still", scene.folder() / "cut.png", "--summary", scene.folder() / "summary.json"});
  // An observer that comes when the cut is half done.
  std::this_thread::sleep_for(2500ms);
  const Scene loaded = load_scene(scene.scene());
  std::vector<Archive> archives{find_archive(loaded, loaded.bodies[0], ArchivePart::header)};
  const auto bus = make_dds_bus({.domain = own_domain()});
  Presence presence(*bus, "render", 0, scene_hash(loaded), archives[0].content_hash);
  TopologyFeed feed(*bus, presence, archives);
  const auto limit = std::chrono::steady_clock::now() + 30s;
  while (run.running() && std::chrono::steady_clock::now() < limit) {
    presence.watch();
    feed.take();
    bus->wait(20ms);
  }
  EXPECT_EQ(run.status(), 0);
  feed.take();

  const auto [gone, cut] = removed_in(log);
  EXPECT_GT(gone.size(), 30u);
  EXPECT_EQ(feed.cuts(), gone.size()) << "who comes late gets every cut";
  for (int t = 0; t < feed.mesh(0).size(); ++t)
    ASSERT_EQ(feed.mesh(0).alive(t), !gone.contains(static_cast<std::uint32_t>(t))) << t;
  const auto known = feed.cut(0);
  EXPECT_EQ(std::set<std::uint32_t>(known.begin(), known.end()), cut);

  const auto summary = nlohmann::json::parse(testing::text_of(scene.folder() / "summary.json"));
  const auto& resection = summary["deform_node"]["resections"].at(0);
  EXPECT_EQ(resection["body"], "block");
  EXPECT_GT(resection["cut_inside"], 0u);
  EXPECT_GT(resection["cut_outside"], 0u);
  EXPECT_EQ(resection["cut_inside"].get<std::size_t>() + resection["cut_outside"].get<std::size_t>(), cut.size());
  const auto& tool = summary["haptic_node"]["tools"].at(0);
  EXPECT_EQ(tool["name"], loaded.tools[0].name);
  EXPECT_NEAR(tool["seconds"].get<double>(), 3.5, 0.1);
  EXPECT_NEAR(tool["path_m"].get<double>(), 0.28, 0.06) << "down, 0.6 rad of 0.21 m, up, and back";
  EXPECT_GT(tool["force_max_n"], 0);

  EXPECT_GT(std::filesystem::file_size(scene.folder() / "cut.png"), 1000u);

  ASSERT_EQ(run_command(program("palpate") + " replay " + log + " --verify", &output), 0) << output;
  EXPECT_NE(output.find("ticks of the tissue end in the recorded state, bit for bit"), std::string::npos) << output;
}

}  // namespace
}  // namespace palpate
