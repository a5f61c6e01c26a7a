// What jaws carry has weight and inertia and nothing else: in hepatectomy, from when the scalpel is off what it has cut
// to the end.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "common/devices/device.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/scene.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/rig/kinds.hpp"
#include "tools/rig/press_rig.hpp"
#include "tools/rig/two_nodes.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kForceps = 0, kSevered = 12000, kEnd = 15000;  // [ticks] in which the segment hangs and is carried away
constexpr double kOff = 0.01;                                // of weight and inertia, by which the force may be off

/// What floats of a body.
struct Momentum {
  double mass = 0;                  ///< [kg]
  Vector3d sum = Vector3d::Zero();  ///< [kg m/s]
};

Momentum floating(const DynamicOrgan& organ) {
  std::vector<int> part;
  organ.topology().parts(part);
  std::vector<char> held(part.size(), 0), listed(organ.mesh().nodes(), 0);
  for (int t = 0; t < organ.topology().size(); ++t)
    for (const int node : organ.topology().tetrahedron(t))
      if (part[t] >= 0 && organ.is_joined(node)) held[part[t]] = 1;
  Momentum all;
  for (int t = 0; t < organ.topology().size(); ++t) {
    if (part[t] < 0 || held[part[t]]) continue;
    for (const int n : organ.topology().tetrahedron(t)) {
      if (std::exchange(listed[n], 1)) continue;
      all.mass += organ.model().mass(n);
      all.sum += organ.model().mass(n) * organ.model().velocity(n);
    }
  }
  return all;
}

TEST(CarriedPiece, HasWeightAndInertiaAndNothingElse) {
  const Scene scene = load_scene(PALPATE_SOURCE_DIR "/scenes/hepatectomy.toml");
  TwoNodes nodes(scene, load_or_precompute(scene, ArchivePart::surface));
  const auto devices = make_devices(scene.tools, scene.rates.haptic_hz);
  const auto at = [&](int k) {
    std::vector<ToolDofs> dofs;
    for (const auto& device : devices) dofs.push_back(device->read(1e-3 * k).dofs);
    return dofs;
  };
  const Vector3d gravity = std::visit([](const auto& body) { return moving_gravity(body); }, scene.bodies[0]);
  nodes.start(at(0));
  constexpr int kMean = 20;  // ticks over which the force is taken, as the momentum is
  Vector3d felt = Vector3d::Zero(), all_felt = Vector3d::Zero();
  std::vector<Vector3d> jaws;  // [m] where they are, per tick
  Momentum before;
  double worst = 0;
  for (int k = 1; k < kEnd; ++k) {
    nodes.step(at(k));
    if (k < kSevered) continue;
    felt += nodes.force(kForceps) / kMean;
    all_felt += nodes.force(kForceps) / (kEnd - kSevered);
    jaws.push_back(nodes.haptic().pose(kForceps).translation());
    if ((k - kSevered) % kMean != kMean - 1) continue;
    const Momentum now = floating(nodes.world().organ(0));
    ASSERT_GT(now.mass, 0);
    if (before.mass > 0) {
      const Vector3d carried = now.mass * gravity - (now.sum - before.sum) / (1e-3 * kMean);
      EXPECT_LT((felt - carried).norm(), kOff * carried.norm()) << "tick " << k;
      worst = std::max(worst, (felt - carried).norm() / carried.norm());
    }
    before = now;
    felt.setZero();
  }
  fmt::print("off by {:.3f} of weight and inertia at most\n", worst);

  // The same without what the tissue says of itself: it swings about the jaws, which the mean over some swings leaves
  // out.
  const Vector3d speeds = (jaws.back() - jaws[jaws.size() - 2]) - (jaws[1] - jaws[0]);  // [m] a tick
  const Vector3d carried = before.mass * (gravity - speeds / 1e-3 / (1e-3 * static_cast<double>(jaws.size() - 2)));
  fmt::print("in the mean {:.4f} N, where {:.4f} kg under the jaws' own motion ask for {:.4f} N, off by {:.4f} N\n",
             all_felt.norm(), before.mass, carried.norm(), (all_felt - carried).norm());
  EXPECT_LT((all_felt - carried).norm(), kOff * carried.norm());
}

/// [J] of motion and of the tissue's springs.
double energy_of(const DynamicOrgan& organ) {
  double sum = 0;
  for (int n = 0; n < organ.mesh().nodes(); ++n) {
    if (!organ.topology().has_node(n)) continue;
    sum += 0.5 * organ.model().mass(n) * organ.model().velocity(n).squaredNorm();
    sum -= 0.5 * organ.model().elastic_force(n).dot(organ.model().displacement(n));
  }
  return sum;
}

// A block that hangs on nothing but the jaws at its top, which move aside and stop: the swing about them, most of it a
// turn of all of it, comes to rest as quickly as tissue's other motions do.
TEST(CarriedPiece, SwingsAboutTheJawsNoLongerThanItsDampingLetsIt) {
  constexpr double kDamping = 5, kWindow = 0.5;  // [1/s]; [s], some swings long
  constexpr int kMoves = 50, kTicks = 3000;
  Scene scene = moving_block_scene(TensorMassSpec{}, 0.3);
  moving_block_of(scene).dynamic.damping = kDamping;
  std::get<ProbeSpec>(scene.tools[0].end).jaws = ClosingJaws{.length = 0.012, .width = 0.012, .closed_below = 0.1};
  PressRig rig(scene, {precompute_on(scene.bodies[0], small_block_mesh())});
  const std::vector<std::array<int, 4>>& all = rig.archives()[0].tetrahedra;
  std::vector<std::uint32_t> below;
  for (std::size_t t = 0; t < all.size(); ++t)
    if (std::ranges::any_of(all[t], [&](int n) { return rig.organ().mesh().fixed[n][2]; }))
      below.push_back(static_cast<std::uint32_t>(t));
  ASSERT_TRUE(rig.tissue().organ(0).begin_without(below));
  const double heavy = floating(rig.organ()).mass;
  ASSERT_GT(heavy, 0);
  std::vector<double> energy(1, 0.0);  // [J] mean of each window
  const int window = static_cast<int>(kWindow / rig.dt());
  for (int k = 0; k < kTicks; ++k) {
    ToolDofs dofs = tip_at(scene.tools[0], {0.005 * std::min(1.0, k / double{kMoves}), 0, 0.024});
    dofs.grip = 0;
    rig.press(std::array{dofs});
    ASSERT_TRUE(rig.organ().holds(0));
    if (k < kMoves) continue;
    energy.back() += energy_of(rig.organ()) / window;
    if ((k - kMoves) % window == window - 1) energy.push_back(0);
  }
  energy.pop_back();
  fmt::print("{:.3f} kg, mean energy in windows of {} s: {:.2g} J\n", heavy, kWindow, fmt::join(energy, ", "));
  ASSERT_GT(energy.size(), 4u);
  ASSERT_GT(energy[0], 1e-7);
  // All of the energy swings between motion and springs, and damping takes from motion alone: exp(-damping t).
  for (std::size_t w = 0; w + 1 < energy.size(); ++w)
    EXPECT_LT(energy[w + 1], 2 * std::exp(-kDamping * kWindow) * energy[w]) << w;
}

}  // namespace
}  // namespace palpate
