// A tip that lies over the rim of a cut is felt by small steps: the squares of its patch come onto the tissue one after
// another, each of them whole.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/devices/device.hpp"
#include "common/fem/dense.hpp"
#include "common/scene/ensure_archive.hpp"
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

// A block with a notch from x = 0 on: the tip comes down within it, clear of all, and goes at 10 mm/s over its rim,
// which it presses as deep as it lies.
TEST(TipOverARim, ComesOntoTheTissueBySmallSteps) {
  Scene scene = moving_block_scene(TensorMassSpec{}, 0.3);
  std::get<ProbeSpec>(scene.tools[0].end).radius = kRadius;
  PressRig rig(scene, {precompute_on(scene.bodies[0], middle_block_mesh())});
  const ElasticMesh& mesh = rig.organ().mesh();
  std::vector<std::uint32_t> notch;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    if (std::ranges::all_of(mesh.tetrahedra[t],
                            [&](int n) { return mesh.rest[n].x() > -1e-6 && mesh.rest[n].z() > kFloor - 1e-6; }))
      notch.push_back(static_cast<std::uint32_t>(t));
  ASSERT_TRUE(rig.tissue().organ(0).begin_without(notch));
  for (int k = 0; k < 200; ++k) rig.press(Vector3d(0.015, 0.0012, kLow + 5e-5 * (200 - k)));
  Felt felt;
  for (int k = 0; k < 1800; ++k) {
    rig.press(Vector3d(0.015 - 1e-5 * k, 0.0012, kLow));
    felt.feel(rig.force());
  }
  fmt::print("{:.3f} N at most, changed by {:.4f} N in a tick at most\n", felt.force, felt.change);
  ASSERT_GT(felt.force, 0.1);
  EXPECT_LT(felt.change, 0.05 * felt.force);
}

/// What a tool of a scene feels in its own motion, from one tick to another.
Felt felt_in(const std::string& name, int tool, int from, int to) {
  set_linear_algebra_threads(1);
  const Scene scene = load_scene(PALPATE_SOURCE_DIR "/scenes/" + name);
  sim::Simulator simulator(scene, load_or_precompute(scene, ArchivePart::surface));
  std::vector<std::unique_ptr<Device>> devices;
  for (int t = 0; t < static_cast<int>(scene.tools.size()); ++t) devices.push_back(make_device(scene, t));
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
  ASSERT_GT(felt.force, 0.05);
  EXPECT_LT(felt.change, 0.03);
}

// The lobe turns under the forceps' tip, which stands: none of its depth has come onto the tissue whole.
TEST(TipOverARim, StandingInALobeThatTurnsKeepsItsForce) {
  const Felt felt = felt_in("hepatectomy.toml", 0, 2430, 2700);
  ASSERT_GT(felt.force, 0.03);
  EXPECT_LT(felt.change, 0.004);
}

}  // namespace
}  // namespace palpate
