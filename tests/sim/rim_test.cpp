// A tip that lies over the rim of a cut is felt by small steps: the squares of its patch come onto the tissue one after
// another, each of them whole.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/devices/device.hpp"
#include "common/scene/ensure_archive.hpp"
#include "tests/deform/work_of_cycles.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/rig/kinds.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kTop = 0.03, kRadius = 0.006, kLow = kTop + kRadius - 0.004, kFloor = 0.02;  // [m]

/// The largest force [N], and the largest change of a force from tick to tick.
struct Felt {
  double force = 0, change = 0;
  Vector3d last = Vector3d::Zero();

  void feel(const Vector3d& now) {
    force = std::max(force, now.norm());
    change = std::max(change, (now - last).norm());
    last = now;
  }
};

/// A block under a tip, with a notch from x = 0 on.
class NotchedBlock {
 public:
  NotchedBlock() : rig_(scene(), {precompute_on(scene().bodies[0], middle_block_mesh())}) {
    const ElasticMesh& mesh = rig_.organ().mesh();
    std::vector<std::uint32_t> notch;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
      if (std::ranges::all_of(mesh.tetrahedra[t],
                              [&](int n) { return mesh.rest[n].x() > -1e-6 && mesh.rest[n].z() > kFloor - 1e-6; }))
        notch.push_back(static_cast<std::uint32_t>(t));
    EXPECT_TRUE(rig_.tissue().organ(0).begin_without(notch));
  }
  /// The tip comes down from 40 mm above: clear of all for as long as the cut tissue wants a tool to be that has come.
  void come_to(const Vector3d& at) {
    for (int k = 0; k < 1600; ++k) rig_.press(Vector3d(at + Vector3d(0, 0, 2.5e-5 * (1600 - k))));
  }
  /// The tip comes down at one place, and goes at 10 mm/s to another, as deep as it lies.
  Felt felt_on_the_way(double from, double to) {
    come_to({from, 0.0012, kLow});
    Felt felt{.last = rig_.force()};
    const int ticks = static_cast<int>(std::abs(to - from) / 1e-5);
    for (int k = 0; k < ticks; ++k) {
      rig_.press(Vector3d(from + (to - from) * k / ticks, 0.0012, kLow));
      felt.feel(rig_.force());
    }
    fmt::print("{:.3f} N at most, changed by {:.4f} N in a tick at most\n", felt.force, felt.change);
    return felt;
  }
  PressRig& rig() { return rig_; }

 private:
  static Scene scene() {
    Scene scene = moving_block_scene(TensorMassSpec{}, 0.3);
    std::get<ProbeSpec>(scene.tools[0].end).radius = kRadius;
    return scene;
  }
  PressRig rig_;
};

// From within the notch, clear of all, over its rim.
TEST(TipOverARim, ComesOntoTheTissueBySmallSteps) {
  const Felt felt = NotchedBlock().felt_on_the_way(0.015, -0.003);
  ASSERT_GT(felt.force, 0.1);
  EXPECT_LT(felt.change, 0.05 * felt.force);
}

TEST(TipOverARim, LeavesTheTissueBySmallSteps) {
  const Felt felt = NotchedBlock().felt_on_the_way(-0.006, 0.015);
  ASSERT_GT(felt.force, 0.1);
  EXPECT_LT(felt.change, 0.05 * felt.force);
}

// Round by round over the rim, deep where it goes one way and high where it comes back.
TEST(TipOverARim, ContactNeverPutsOutWork) {
  NotchedBlock block;
  const auto tip = [](double turn) { return Vector3d(0.006 * std::cos(turn), 0.0012, kLow + 0.001 * std::sin(turn)); };
  block.come_to(tip(0));
  for (const double way : {1.0, -1.0}) {
    const auto work = testing::work_of_cycles(block.rig(), tip(0), [&](double turn) { return tip(way * turn); });
    fmt::print("work from {:.3g} to {:.3g} J\n", work.least, work.most);
    EXPECT_GT(work.most, 1e-5);
    EXPECT_GT(work.least, -1e-3 * work.most);
  }
}

/// What a tool of a scene feels in its own motion, from one tick to another.
Felt felt_in(const std::string& name, int tool, int from, int to) {
  const Scene scene = load_scene(PALPATE_SOURCE_DIR "/scenes/" + name);
  sim::Simulator simulator(scene, load_or_precompute(scene, ArchivePart::surface));
  const auto devices = make_devices(scene.tools, scene.rates.haptic_hz);
  const auto inputs = [&](int k) {
    std::vector<sim::ToolInput> inputs;
    for (const auto& device : devices) inputs.push_back(device->read(1e-3 * k));
    return inputs;
  };
  simulator.start(inputs(0));
  Felt felt;
  for (int k = 1; k < to; ++k) {
    simulator.step(inputs(k));
    if (k == from) felt.last = simulator.tool(tool).force;
    if (k >= from) felt.feel(simulator.tool(tool).force);
  }
  fmt::print("{:.3f} N at most, changed by {:.4f} N in a tick at most\n", felt.force, felt.change);
  return felt;
}

TEST(TipOverARim, OfAPlateThatIsCutIsFeltBySmallSteps) {
  const Felt felt = felt_in("plate_cut.toml", 0, 1, 6000);
  ASSERT_GT(felt.force, 0.03);
  EXPECT_LT(felt.change, 0.015);
}

// The lobe turns under the forceps' tip, which stands: none of its depth has come onto the tissue whole.
TEST(TipOverARim, StandingInALobeThatTurnsKeepsItsForce) {
  const Felt felt = felt_in("hepatectomy.toml", 0, 2430, 2700);
  ASSERT_GT(felt.force, 0.03);
  EXPECT_LT(felt.change, 0.004);
}

}  // namespace
}  // namespace palpate
