#include <gtest/gtest.h>

#include <thread>

#include "common/archive/compliance.hpp"
#include "common/mesh/generators.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/scene/find_archive.hpp"
#include "common/scene/scene.hpp"
#include "tests/bus/domain.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using testing::kLinear;
using testing::LoopbackScene;
using testing::program;

struct Footprint {
  double resident = 0;    ///< [bytes] of the haptic node that waits for its driver; it locks its threads' stacks later
  double peak = 0;        ///< [bytes] until then
  double compliance = 0;  ///< [bytes] of its touchable tensors, unpacked
  double packed = 0;      ///< [bytes] of the same in the archive
  double others = 0;      ///< [bytes] of the tensors of visible nodes that are not touchable, in the archive
};

double memory_of(pid_t pid, const std::string& key) {
  std::ifstream status(fmt::format("/proc/{}/status", pid));
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key)) return 1024 * std::stod(line.substr(key.size()));
  ADD_FAILURE() << "no " << key << " of process " << pid;
  return 0;
}

Footprint footprint_of(const LoopbackScene& at) {
  at.replace("device = \"scripted\"\ntrajectory = \"motion.csv\"", "device = \"bus\"");
  write_tet_mesh(make_block({-0.05, -0.05, -0.05}, {0.05, 0.05, 0}, {20, 20, 5}), at.folder() / "block.msh");
  const auto made = testing::run_program(program("palpate") + " precompute " + at.scene());
  EXPECT_EQ(made.status, 0) << made.err;
  const Scene scene = load_scene(at.scene());
  const Archive archive = find_archive(scene, scene.bodies[0], ArchivePart::surface);
  const int touchable = archive.surface.touchable;
  Footprint footprint{.compliance = static_cast<double>(Compliance<double>::bytes_of(touchable, touchable)),
                      .packed = 8.0 * static_cast<double>(archive.touchable_compliance.size()),
                      .others = 8.0 * static_cast<double>(archive.other_compliance.size())};

  ChildProcess haptic("haptic_node", {program("haptic_node"), at.scene(), "--domain",
                                      std::to_string(testing::own_domain()), "--supervised"});
  std::vector<std::string> lines;
  for (const auto end = std::chrono::steady_clock::now() + 60s;
       lines.empty() && std::chrono::steady_clock::now() < end;) {
    std::this_thread::sleep_for(10ms);
    lines = haptic.take_lines();
  }
  EXPECT_EQ(lines, std::vector<std::string>{"ready"});
  footprint.resident = memory_of(haptic.pid(), "VmRSS:");
  footprint.peak = memory_of(haptic.pid(), "VmHWM:");
  EXPECT_TRUE(haptic.running());
  return footprint;
}

TEST(ToolsHapticMemory, TheHapticNodeHoldsTheTensorsOfTouchableNodesAlone) {
  const Footprint all = footprint_of(LoopbackScene("touch-all", kLinear));
  const Footprint half = footprint_of(LoopbackScene(
      "touch-half", std::string(kLinear) + "[body.touchable]\nbox = [[-1.0, -1.0, -1.0], [0.001, 1.0, 1.0]]\n"));
  const double saved = all.compliance - half.compliance;
  ASSERT_GT(saved, 20e6);
  ASSERT_GT(half.others, 8e6) << "the restricted archive has blocks that the haptic node must leave alone";
  // An allocator may keep a few freed pages; loading the other blocks would take more than the tenth allowed here.
  const double difference = all.resident - half.resident;
  EXPECT_GE(difference, 0.9 * saved) << "resident " << all.resident << " and " << half.resident;
  EXPECT_LE(difference, 1.1 * saved) << "resident " << all.resident << " and " << half.resident;
  const double loading = saved + all.packed - half.packed;
  ASSERT_GT(half.others, 0.15 * loading);
  EXPECT_GE(all.peak - half.peak, 0.9 * loading) << "peak " << all.peak << " and " << half.peak;
  EXPECT_LT(half.resident, half.compliance + 60e6) << "the node beside its tensors";
}

}  // namespace
}  // namespace palpate
