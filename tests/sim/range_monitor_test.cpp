#include "common/sim/range_monitor.hpp"

#include <gtest/gtest.h>

#include "common/models/quasi_static/precompute.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// A kidney, and a probe above it.
struct Kidney {
  Kidney() {
    scene.bodies = {kidney_body()};
    archives = {precompute(kidney_body(), kidney_mesh())};
  }

  /// What the monitor says of a press to each depth [m] in turn, all of one run.
  std::vector<std::string> press(const std::vector<double>& depths) {
    PressRig rig(scene, archives);
    Deformer deformer(scene, archives);
    monitor.emplace(scene, deformer);
    const double radius = std::get<ProbeSpec>(scene.tools[0].end).radius;
    double at = -1e-3;
    const auto tip = [&](double depth) { return Vector3d(0.002, 0.001, kKidneyTop + radius - depth); };
    rig.start(tip(at));
    std::vector<std::string> said;
    for (const double depth : depths) {
      for (int i = 1; i <= 40; ++i) rig.step(tip(at + (depth - at) * i / 40));
      at = depth;
      ContactState state = rig.simulator().contacts(0);
      state.run = 7;
      EXPECT_TRUE(deformer.take(state));
      deformer.deform();
      for (std::string& sentence : monitor->look(deformer)) said.push_back(std::move(sentence));
    }
    return said;
  }

  Scene scene = block_scene();
  std::vector<Archive> archives;
  std::optional<RangeMonitor> monitor;
};

TEST(RangeMonitor, AGentlePressStaysWithinItsRange) {
  Kidney kidney;
  EXPECT_TRUE(kidney.press({0.001, 0.002, 0.003}).empty());
  EXPECT_EQ(kidney.monitor->warning(), "");
  EXPECT_FALSE(kidney.monitor->watched()[0].left);
  EXPECT_GT(kidney.monitor->watched()[0].most.change.stretch, 0.01);
}

TEST(RangeMonitor, APressOf30MillimetresIsSaidOnceAndShownUntilItEnds) {
  Kidney kidney;
  const auto said = kidney.press({0.01, 0.02, 0.03});
  ASSERT_EQ(said.size(), 1u);
  EXPECT_TRUE(said[0].starts_with("kidney beyond its linear range: stretch ")) << said[0];
  EXPECT_NE(kidney.monitor->warning(), "");
  EXPECT_TRUE(kidney.monitor->watched()[0].left);
  EXPECT_GT(std::abs(kidney.monitor->watched()[0].most.change.volume), kMaxVolume);
  EXPECT_EQ(kidney.press({0.03, -0.005}).size(), 1u);
  EXPECT_EQ(kidney.monitor->warning(), "");  // the tool has gone
  EXPECT_TRUE(kidney.monitor->watched()[0].left);
}

}  // namespace
}  // namespace palpate
