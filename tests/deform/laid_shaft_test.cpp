// A shaft laid on tissue that moves presses by a patch of its own; on what a cut has laid open it rests on points of
// the triangles, each of which gives way as under a patch.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "tests/deform/block_bench.hpp"
#include "tests/deform/work_of_cycles.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::block_scene;

constexpr double kSurface = 0.03, kShaftRadius = 0.003, kLaid = 0.002;  // [m]

/// The shaft lies level along x over all of the block, its tip beyond it.
Scene laid_scene(double friction) {
  Scene scene = block_scene();
  Tool& tool = scene.tools[0];
  tool.pivot = {-20, 0, kSurface + kShaftRadius};
  tool.axis = Vector3d::UnitX();
  tool.up = Vector3d::UnitZ();
  tool.shaft_radius = kShaftRadius;
  tool.shaft_length = 0.12;
  scene.contact.friction = friction;
  return scene;
}

PressRig laid_rig(const Scene& scene) {
  return {scene, {precompute_on(scene.bodies[0], middle_block_mesh(6))}};
}

Vector3d laid_tip(double aside, double depth) {
  return {0.06, 0.0013 + aside, kSurface + kShaftRadius - depth};
}

constexpr double kLayer = 0.01;  // [m]

/// The uppermost layer of cells has been cut away: what lies bare is touched by points.
bool begin_without_top(PressRig& rig) {
  const ElasticMesh& mesh = rig.organ().mesh();
  std::vector<std::uint32_t> layer;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    if (std::ranges::all_of(mesh.tetrahedra[t], [&](int n) { return mesh.rest[n].z() > kSurface - kLayer - 1e-6; }))
      layer.push_back(static_cast<std::uint32_t>(t));
  return rig.tissue().organ(0).begin_without(layer);
}

void lay_down(PressRig& rig, double aside, int ticks = 600) {
  for (int i = 0; i < ticks; ++i) rig.press(laid_tip(aside, -0.001 + (kLaid + 0.001) * std::min(1.0, i / 300.0)));
}

double felt_when_laid(const Scene& scene, double aside) {
  PressRig rig = laid_rig(scene);
  lay_down(rig, aside);
  return rig.force().norm();
}

TEST(LaidShaft, FeelsAtRestWhatItsStripDoesOnTissueWithoutInertia) {
  const Scene moving = laid_scene(0);
  Scene still = moving;
  auto body = as_kind<QuasiStaticSpec>(moving.bodies[0]);
  body.offline = Offline{};
  still.bodies[0] = body;
  for (const double aside : {-0.004, 0.0, 0.003}) {
    const double wanted = felt_when_laid(still, aside), felt = felt_when_laid(moving, aside);
    EXPECT_NEAR(felt, wanted, 2e-3 * wanted) << "at y = " << aside;
  }
}

/// [N] Of a level shaft whose ball, half as wide again, is pressed into the block at x = 0, the shaft beside it.
double felt_with_its_tip(const Scene& scene) {
  PressRig rig = laid_rig(scene);
  for (int i = 0; i < 900; ++i) rig.press({0, 0.0013, testing::from_above(i, 500, kSurface + 0.006, kSurface + 0.002)});
  return rig.force().norm();
}

// Each lies in the other's dent.
TEST(LaidShaft, WithItsTipFeelsWhatItDoesOnTissueWithoutInertia) {
  Scene moving = laid_scene(0);
  std::get<ProbeSpec>(moving.tools[0].end).radius = 0.0045;
  Scene still = moving;
  auto body = as_kind<QuasiStaticSpec>(moving.bodies[0]);
  body.offline = Offline{};
  still.bodies[0] = body;
  const double wanted = felt_with_its_tip(still);
  EXPECT_NEAR(felt_with_its_tip(moving), wanted, 0.01 * wanted);
}

TEST(LaidShaft, AStrikeIsNoBlow) {
  for (const double speed : {0.05, 0.2}) {
    PressRig rig = laid_rig(laid_scene(0));
    double largest = 0;
    const auto press = [&](double depth) {
      const Vector3d before = rig.force();
      rig.press(laid_tip(0, depth));
      largest = std::max(largest, (rig.force() - before).norm());
    };
    for (double depth = -0.002; depth < kLaid; depth += speed * rig.dt()) press(depth);
    for (int i = 0; i < 1000; ++i) press(kLaid);
    const double held = rig.force().norm();
    EXPECT_LT(largest, 3 * held * speed * rig.dt() / kLaid);
  }
}

// A scalpel glows where the shaft lies.
TEST(LaidShaft, WhatIsCutAwayUnderItLetsGoBySmallSteps) {
  Scene scene = laid_scene(0.2);
  Tool scalpel = block_scene().tools[0];
  scalpel.name = "scalpel";
  std::get<ProbeSpec>(scalpel.end) = {.radius = 0.002, .cautery = Cautery{0.006}};
  scene.tools.push_back(scalpel);
  PressRig rig = laid_rig(scene);
  const auto press = [&](double depth, double pedal) {
    std::array dofs{tip_at(scene.tools[0], laid_tip(0, depth)),
                    tip_at(scalpel, Vector3d(0.004, 0.007, kSurface + 0.002))};
    dofs[1].pedal = pedal;
    rig.press(dofs);
  };
  const auto felt = [&] {
    Vector3d sum = Vector3d::Zero();
    for (const TouchContact& c : rig.organ().contacts())
      if (c.is_by(0)) sum += c.force;
    return sum;
  };
  for (int i = 0; i < 600; ++i) press(-0.001 + (kLaid + 0.001) * std::min(1.0, i / 300.0), 0);
  const double held = felt().norm();
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d before = felt();
    press(kLaid, i == 0);
    worst = std::max(worst, (felt() - before).norm());
  }
  EXPECT_FALSE(rig.organ().removed().empty());
  EXPECT_LT(worst, 0.1 * held);
}

class LaidShaftSlides : public ::testing::TestWithParam<double> {};

// Across the triangles' edges, there and back at 50 mm/s at most.
TEST_P(LaidShaftSlides, HasNoJumpFromTriangleToTriangle) {
  PressRig rig = laid_rig(laid_scene(GetParam()));
  lay_down(rig, -0.01);
  double worst = 0;
  constexpr int ticks = 1256;
  for (int i = 1; i <= ticks; ++i) {
    const Vector3d before = rig.force();
    rig.press(laid_tip(-0.01 * std::cos(2 * std::numbers::pi * i / ticks), kLaid));
    worst = std::max(worst, (rig.force() - before).norm() / rig.force().norm());
  }
  EXPECT_LT(worst, 0.015);
}

// Drawn along itself at 20 mm/s over the block without its uppermost layer: what friction has bent where a point gives
// way stays bent as the point slides. Where it went straight again in each step that slid, the shaft stuck and slipped
// by turns.
TEST_P(LaidShaftSlides, FrictionStaysAsItSlidesOverACutFace) {
  const double friction = GetParam();
  PressRig rig = laid_rig(laid_scene(friction));
  ASSERT_TRUE(begin_without_top(rig));
  const Vector3d lower(0, 0, -kLayer);
  for (int i = 0; i < 1500; ++i) rig.press(lower + laid_tip(0, testing::from_above(i, 1200, -0.02, kLaid)));
  ASSERT_GT(rig.force().norm(), 0.1);
  double least = 1, jump = 0;
  for (int i = 1; i <= 400; ++i) {
    const Vector3d before = rig.force();
    rig.press(lower + laid_tip(0, kLaid) + Vector3d(2e-5 * i, 0, 0));
    if (i <= 200) continue;  // until all points slide
    least = std::min(least, rig.force().x() / -rig.force().z());
    jump = std::max(jump, (rig.force() - before).norm() / rig.force().norm());
  }
  EXPECT_GT(least, 0.75 * friction - 0.002);
  EXPECT_LT(jump, 0.005);
}

// Laid down, drawn aside and lifted, over and over.
testing::WorkOfCycles work_of_laying(PressRig& rig, double lower) {
  const auto tip = [=](double turn) -> Vector3d {
    return laid_tip(-0.01 * std::cos(turn), 0.0005 - 0.0015 * std::cos(turn) + 0.001 * std::sin(turn)) -
           lower * Vector3d::UnitZ();
  };
  return testing::work_of_cycles(rig, tip(0), tip);
}

// What the tool gets back is never more than what it has put in.
TEST_P(LaidShaftSlides, ContactNeverPutsOutWork) {
  PressRig rig = laid_rig(laid_scene(GetParam()));
  const testing::WorkOfCycles work = work_of_laying(rig, 0);
  EXPECT_GT(work.most, 1e-5);
  EXPECT_GT(work.least, -1e-3 * work.most);
}

// Points do put out work, as they leave triangles without friction.
TEST_P(LaidShaftSlides, PointsOverACutFacePutOutWorkOnlyWithoutFriction) {
  PressRig rig = laid_rig(laid_scene(GetParam()));
  ASSERT_TRUE(begin_without_top(rig));
  for (int i = 0; i < 300; ++i)
    rig.press(laid_tip(-0.01, testing::from_above(i, 200, -0.02, -0.001)) - kLayer * Vector3d::UnitZ());
  const testing::WorkOfCycles work = work_of_laying(rig, kLayer);
  EXPECT_GT(work.most, 1e-5);
  EXPECT_GT(work.least, (GetParam() == 0 ? -0.6 : -1e-3) * work.most) << work.least / work.most;
}

INSTANTIATE_TEST_SUITE_P(Friction, LaidShaftSlides, ::testing::Values(0, 0.1, 0.2));

}  // namespace
}  // namespace palpate
