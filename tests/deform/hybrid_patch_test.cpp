// A tip presses a hybrid body by one patch, on whichever of its parts it lies.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/deform/block_bench.hpp"
#include "tests/deform/work_of_cycles.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::block_scene;

constexpr double kFace = 0.03, kBall = 0.006, kDeep = 0.003;  // [m]
constexpr double kSeam = 0.0026;                              // [m] x: what lies before it has no inertia

Scene hybrid_scene(double friction) {
  HybridSpec split;
  split.hybrid.regions.push_back({{.box = Box{Vector3d(kSeam, -1, -1), Vector3d(1, 1, 1)}}});
  Scene scene = block_scene(split);
  scene.contact.friction = friction;
  return scene;
}

PressRig rig_of(const Scene& scene, int cells = 6) {
  return {scene, {precompute_on(scene.bodies[0], middle_block_mesh(cells))}};
}

double smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Vector3d tip(double x, double depth) {
  return {x, 0.0013, kFace + kBall - depth};
}

void press_down(PressRig& rig, double x, int ticks = 600) {
  for (int i = 0; i < ticks; ++i) rig.press(tip(x, -0.0005 + (kDeep + 0.0005) * smooth(i / 300.0)));
}

double felt_at_rest(const Scene& scene, double x) {
  PressRig rig = rig_of(scene);
  press_down(rig, x);
  return rig.force().norm();
}

TEST(HybridPatch, IsAtRestThePatchOnTissueWithoutInertia) {
  const Scene hybrid = hybrid_scene(0);
  Scene still = hybrid;
  auto body = as_kind<QuasiStaticSpec>(hybrid.bodies[0]);
  body.offline = Offline{};
  still.bodies[0] = body;
  for (const double x : {-0.012, -0.004, 0.001, 0.004, 0.013}) {
    const double wanted = felt_at_rest(still, x);
    EXPECT_GT(wanted, 0.03);
    EXPECT_NEAR(felt_at_rest(hybrid, x), wanted, 0.005 * wanted) << "at x = " << x;
  }
}

TEST(HybridPatch, IsLiftedWhileJawsHoldThePartWithoutInertia) {
  Scene scene = hybrid_scene(0.2);
  std::get<ProbeSpec>(scene.tools[0].end).jaws = ClosingJaws{0.012, 0.012, 0.1};
  PressRig rig = rig_of(scene);
  const auto press = [&](double depth, double grip) {
    ToolDofs dofs = tip_at(scene.tools[0], tip(-0.012, depth));
    dofs.grip = grip;
    rig.press(std::array{dofs});
  };
  for (int i = 0; i < 300; ++i) press(-0.0005 + 0.0015 * smooth(i / 200.0), 0.6);
  ASSERT_FALSE(rig.organ().contacts().empty()) << "the patch";
  for (int i = 0; i < 100; ++i) press(0.001, 0.05);
  ASSERT_TRUE(rig.organ().condensed_part()->grasping(0));
  EXPECT_TRUE(rig.organ().contacts().empty());
}

class HybridPatchSlides : public ::testing::TestWithParam<double> {};

TEST_P(HybridPatchSlides, AHeldToolDoesNotChatter) {
  for (const double young : {5e3, 5e6})
    for (const double x : {-0.012, 0.001, 0.013}) {
      Scene scene = hybrid_scene(GetParam());
      moving_block_of(scene).material.young = young;
      PressRig rig = rig_of(scene);
      press_down(rig, x);
      double sum = 0, squares = 0;
      constexpr int ticks = 400;
      for (int i = 0; i < ticks; ++i) {
        rig.press(tip(x, kDeep));
        sum += rig.force().norm();
        squares += rig.force().squaredNorm();
      }
      const double mean = sum / ticks, rms = std::sqrt(std::max(0.0, squares / ticks - mean * mean));
      EXPECT_GT(mean, 6e-6 * young);
      EXPECT_LT(rms, 0.002 * mean) << "at x = " << x << ", " << young << " Pa";
    }
}

// There and back over the seam at 50 mm/s, judged once it slides.
TEST_P(HybridPatchSlides, ASlideOverTheSeamHasNoJump) {
  PressRig rig = rig_of(hybrid_scene(GetParam()));
  constexpr double before_seam = -0.014, behind_seam = 0.016;
  press_down(rig, before_seam);
  constexpr int ticks = 600;
  double worst = 0;
  for (int i = 1; i <= 2 * ticks; ++i) {
    const double share = 1 - std::abs(1 - static_cast<double>(i) / ticks);
    const double x = before_seam + (behind_seam - before_seam) * share;
    const Vector3d before = rig.force();
    rig.press(tip(x, kDeep));
    ASSERT_GT(rig.force().norm(), 0.03);
    if (std::abs(x - kSeam) < 0.009) worst = std::max(worst, (rig.force() - before).norm() / rig.force().norm());
  }
  EXPECT_LT(worst, 0.01);
}

// As the hand feels it, by local contact models.
TEST_P(HybridPatchSlides, TheHandFeelsNoJumpAtTheSeam) {
  PressRig rig = rig_of(hybrid_scene(GetParam()));
  rig.start(tip(-0.012, -0.0005));
  for (int i = 0; i < 600; ++i) rig.step(tip(-0.012, -0.0005 + (kDeep + 0.0005) * smooth(i / 300.0)));
  double worst = 0;
  for (int i = 1; i <= 600; ++i) {
    const Vector3d before = rig.haptic().force(0);
    rig.step(tip(-0.012 + 0.026 * smooth(i / 600.0), kDeep));
    const Vector3d now = rig.haptic().force(0);
    ASSERT_GT(now.norm(), 0.02);
    worst = std::max(worst, (now - before).norm() / now.norm());
  }
  EXPECT_LT(worst, 0.02);
}

// Pressed on one part, drawn over the seam and let go on the other, over and over: what the tool gets back is never
// more than what it has put in.
TEST_P(HybridPatchSlides, ContactNeverPutsOutWork) {
  PressRig rig = rig_of(hybrid_scene(GetParam()));
  const testing::WorkOfCycles work = testing::work_of_cycles(rig, tip(-0.01, -0.001), [](double turn) {
    return tip(-0.01 * std::cos(turn), 0.001 - 0.002 * std::cos(turn) + 0.001 * std::sin(turn));
  });
  EXPECT_GT(work.most, 1e-5);
  EXPECT_GT(work.least, -1e-3 * work.most);
}

INSTANTIATE_TEST_SUITE_P(Friction, HybridPatchSlides, ::testing::Values(0.0, 0.2));

// A second tool cuts the moving part away beside a tip that presses over the seam: what the mesh takes along goes by
// small steps.
TEST(HybridPatch, StaysOnWhatACutBesideItLeaves) {
  Scene scene = hybrid_scene(0.2);
  scene.tools.push_back(scene.tools[0]);
  Tool& scalpel = scene.tools[1];
  scalpel.name = "scalpel";
  std::get<ProbeSpec>(scalpel.end) = {.radius = 0.004, .cautery = Cautery{0.005}};
  PressRig rig = rig_of(scene, 12);
  const auto press = [&](double depth, double beside, double pedal) {
    std::array dofs{tip_at(scene.tools[0], tip(-0.002, depth)),
                    tip_at(scalpel, Vector3d(beside, 0.0013, kFace + 0.0045))};
    dofs[1].pedal = pedal;
    rig.press(dofs);
  };
  for (int i = 0; i < 600; ++i) press(-0.0005 + (kDeep + 0.0005) * smooth(i / 300.0), 0.024, 0);
  const auto felt = [&] {
    Vector3d sum = Vector3d::Zero();
    for (const TouchContact& c : rig.organ().contacts())
      if (c.is_by(0)) sum += c.force;
    return sum;
  };
  double worst = 0, least = felt().norm();
  for (int i = 0; i < 800; ++i) {
    const Vector3d before = felt();
    press(kDeep, 0.024 - 0.008 * std::min(1.0, i / 600.0), 1);
    worst = std::max(worst, (felt() - before).norm());
    least = std::min(least, felt().norm());
  }
  EXPECT_FALSE(rig.organ().removed().empty());
  EXPECT_GT(least, 0.03);
  EXPECT_LT(worst, 0.0005);
}

TEST(HybridPatch, GoesOnBitForBitFromAKeyframe) {
  const Scene scene = hybrid_scene(0.2);
  PressRig first = rig_of(scene);
  PressRig second(scene, first.archives());
  const auto move = [](PressRig& rig, int i) { rig.press(tip(-0.01 + 2e-5 * i, std::min(kDeep, 1e-5 * i))); };
  const int keyframe = static_cast<int>(first.tissue().keyframe_interval());
  for (int i = 0; i < keyframe; ++i) move(first, i);
  ASSERT_FALSE(first.organ().contacts().empty());
  second.tissue().restore(first.tissue().save());
  for (int node = 0; node < first.archives()[0].surface.size(); ++node)
    ASSERT_EQ(first.organ().position(node), second.organ().position(node)) << "as it is shown at once, node " << node;
  for (int i = keyframe; i < 2 * keyframe; ++i) {
    move(first, i);
    move(second, i);
    ASSERT_EQ(first.tissue().hash(), second.tissue().hash()) << "tick " << i;
    ASSERT_EQ(first.force(), second.force()) << "tick " << i;
  }
}

}  // namespace
}  // namespace palpate
