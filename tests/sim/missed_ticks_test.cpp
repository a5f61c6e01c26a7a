// What the hand feels of moving tissue when the deformation node began late or missed ticks: triangles larger than the
// tip, friction, a press and a slide.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "common/mesh/generators.hpp"
#include "common/sim/dynamic_world.hpp"
#include "tests/sim/played_scenes.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate::sim {
namespace {

constexpr double kRadius = 0.008;         // [m] of the tip; the block's cells are 12.5 mm wide
constexpr int kDown = 500, kAside = 800;  // ticks by which the tip is down, and has slid
constexpr int kRest = 2000;               // ticks for which it stands before it goes down, where a test asks for it

class MissedTicks : public ::testing::Test {
 protected:
  MissedTicks() {
    TensorMassSpec block;
    block.name = "block";
    block.material = {5000, 0.4, 1000};
    block.fixed.push_back({.where = {.indices = {}, .box = {}, .group = "bottom"}});
    block.dynamic.damping = 20;
    scene_.bodies.push_back(block);
    Tool tool;
    tool.name = "probe";
    tool.pivot = {0, 0, 0.2};
    tool.axis = -Eigen::Vector3d::UnitZ();
    tool.up = Eigen::Vector3d::UnitY();
    tool.end = ProbeSpec{.radius = kRadius};
    scene_.tools.push_back(tool);
    const TetMesh mesh = make_block({-0.05, -0.05, -0.05}, {0.05, 0.05, 0}, {8, 8, 4});
    archives_.push_back(precompute_moving(block, kind_of(scene_.bodies[0]), mesh));
    undisturbed_ = feel(0, [](int) { return false; });
  }

  /// From 0 to 1 without a jerk at either end.
  static double eased(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  }
  /// The tip goes down to 5 mm within the block's top and then 11 mm aside, towards `kAlong`.
  static Eigen::Vector3d tip(int k) {
    const double down = eased(k / double{kDown}), aside = eased((k - kDown) / double{kAside - kDown});
    return Eigen::Vector3d(0, 0, kRadius + 0.019 - 0.024 * down) + 0.011 * aside * along();
  }
  static Eigen::Vector3d along() { return Eigen::Vector3d(-0.9, -0.4, 0).normalized(); }

  struct Felt {
    double end = 0, largest = 0, jump = 0;  ///< [N]
    double with = 0;                        ///< [N] largest on the tool along its motion while it slides
    double changes = 0;                     ///< [N^2] sum of squares of changes in a tick
    double drift = 0;                       ///< [N] from a second after the motion's end to the next
    int lost = 0;  ///< ticks in which the tissue did not follow the tool, and told nothing of it
  };
  /// The deformation node's part from tick `first` on. A tick is missed if `missed` says so; in tick k the tool's
  /// newest state is late(k) steps old.
  template <class Missed>
  Felt feel(
      int first, Missed&& missed, const std::function<int(int)>& late = [](int) { return 0; }) {
    PressRig rig(scene_, archives_);
    Felt felt;
    double before = 0, settled = 0;
    int taken = first - 1;
    for (int k = first; k < kAside + 2000; ++k) {
      if (k < kAside + 200 && missed(k)) continue;
      if (const int step = k - late(k); step > taken) {
        const ToolDofs d = tip_at(scene_.tools[0], tip(step));
        rig.tissue().take({.tool = 0,
                           .run = 1,
                           .step = std::uint64_t(step + kRest),
                           .yaw = d.yaw,
                           .pitch = d.pitch,
                           .depth = d.depth});
        taken = step;
      }
      rig.tissue().tick();
      felt.lost += k > 0 && !rig.tissue().tool(0).follows();
      felt.end = rig.force().norm();
      felt.largest = std::max(felt.largest, felt.end);
      felt.jump = std::max(felt.jump, std::abs(felt.end - before));
      felt.changes += (felt.end - before) * (felt.end - before);
      if (k > kDown && k < kAside) felt.with = std::max(felt.with, -rig.force().dot(along()));
      before = felt.end;
      if (k == kAside + 1000) settled = felt.end;
    }
    felt.drift = std::abs(felt.end - settled);
    return felt;
  }

  static void expect_as(const Felt& felt, const Felt& undisturbed) {
    EXPECT_NEAR(felt.end, undisturbed.end, 0.1 * undisturbed.end);  // friction remembers the way there
    EXPECT_LT(felt.largest, 1.1 * undisturbed.largest);
    EXPECT_LT(felt.jump, 0.25 * undisturbed.end);
    EXPECT_LT(felt.drift, 1e-3 * undisturbed.end);
  }

  Scene scene_;
  std::vector<Archive> archives_;
  Felt undisturbed_;
};

TEST_F(MissedTicks, ASlidingTipIsHeldBackAndNotDrivenOn) {
  EXPECT_LT(undisturbed_.with, 0.002 * undisturbed_.largest);
  EXPECT_LT(undisturbed_.largest, 1.1 * undisturbed_.end);
  EXPECT_LT(undisturbed_.jump, 0.2 * undisturbed_.end);
  EXPECT_LT(undisturbed_.drift, 1e-3 * undisturbed_.end);
}

TEST_F(MissedTicks, TissueThatFirstHearsOfAToolWithinItStrikesNoBlow) {
  for (const int first : {420, 460, 500, 600, 700, 900}) {
    SCOPED_TRACE(first);
    expect_as(feel(first, [](int) { return false; }), undisturbed_);
  }
}

TEST_F(MissedTicks, WhatWasMissedComesInSlowly) {
  for (int seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    int until = 0;
    expect_as(feel(0,
                   [&](int k) {
                     if (k >= until && random() % 10 == 0) until = k + static_cast<int>(random() % 60);
                     return k < until;
                   }),
              undisturbed_);
  }
}

TEST_F(MissedTicks, StatesThatComeUnevenlyAreNotFelt) {
  const auto never = [](int) { return false; };
  const Felt by_turns = feel(0, never, [](int k) { return k % 2; });
  std::mt19937 random(7);
  const Felt at_random = feel(0, never, [&](int) { return static_cast<int>(random() % 3); });
  for (const Felt& felt : {by_turns, at_random}) {
    expect_as(felt, undisturbed_);
    EXPECT_LT(felt.jump, 1.5 * undisturbed_.jump);
    EXPECT_LT(felt.changes, 1.5 * undisturbed_.changes);
  }
}

TEST_F(MissedTicks, ATissueTooSlowForItsTicksIsFelt) {
  for (const int of : {2, 3, 5}) {
    SCOPED_TRACE(of);
    const Felt felt = feel(-kRest, [of](int k) { return k % of != 0; });
    expect_as(felt, undisturbed_);
    EXPECT_EQ(felt.lost, 0);
  }
}

}  // namespace
}  // namespace palpate::sim
