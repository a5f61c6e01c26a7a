// Segments that are thrust through surfaces and walls.
#include <gtest/gtest.h>

#include <random>

#include "tests/contact/patch_touch.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::flat_patch;
using testing::HandledTool;
using testing::PatchTouch;
using testing::settle;
using testing::step;

TEST(SegmentThrust, NoSpeedAndNoTurnCarriesASegmentThroughASurface) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double edge : {0.0012, 0.004}) {
    const int n = static_cast<int>(0.048 / edge) + 1;
    PatchTouch touch(flat_patch(n, edge, 1e-3), 0.3, 1);
    for (int round = 0; round < 60; ++round) {
      touch.law().clear();
      HandledTool tool = HandledTool::segment(0.012, 0.0015);
      const auto direction = [&] { return Vector3d(unit(random), unit(random), 0.7 * unit(random)).normalized(); };
      const auto lowest_at = [&](const Vector3d& along, double height) {  // the axis' lowest point at this height
        return Vector3d(0.004 * unit(random), 0.004 * unit(random), height - std::min(0.0, 0.012 * along.z()));
      };
      const Vector3d from = direction(), to = direction();
      tool.place_at(lowest_at(from, 0.004), from);
      for (int i = 0; i < 3; ++i) {
        tool.stay();
        step(touch, tool);
      }
      // In one step the whole segment goes below the surface: by millimetres, or by centimetres.
      const double below = -std::max(0.0, 0.012 * to.z()) - std::pow(10.0, -2 - unit(random)) * 0.6;
      tool.move_to(Vector3d(0.004 * unit(random), 0.004 * unit(random), below), to);
      step(touch, tool);
      ASSERT_GT(touch.force(0).z(), 0) << "edge " << edge << " round " << round;
      for (int i = 0; i < 40; ++i) {  // back, and the surface springs to rest
        tool.move_to(tool.pose().translation() + Vector3d(0, 0, (0.016 - below) / 40), to);
        step(touch, tool);
        ASSERT_TRUE(touch.force(0).allFinite());
      }
      settle(touch, tool, 3);
      ASSERT_EQ(touch.pressing(), 0) << "edge " << edge << " round " << round;
    }
  }
}

TEST(SegmentThrust, ForcedThroughAThinWallTheForceKeepsOutwardAndTheJawComesBackOnItsSide) {
  const ForcepsShape shape{.shaft_radius = 0.0025, .shaft_length = 0.05, .jaw_length = 0.014, .jaw_radius = 0.001};
  const double half_thickness = 0.0003;
  for (const double edge : {0.0010, 0.0025})
    for (const double tilt : {0.0, 0.5, 1.2}) {  // flat to end first
      const int n = static_cast<int>(0.04 / edge) + 1;
      PatchTouch touch(flat_patch(n, edge, 2e-3), 0.3, 3, {.offset = half_thickness, .softness = {1e-4}});
      HandledTool tool = HandledTool::forceps(shape, 0.2);
      const Vector3d along = Vector3d(std::cos(tilt), 0, -std::sin(tilt));
      const double clear = 0.0155 * std::sin(tilt + 0.1) + 0.004;
      const Vector3d start(-0.007 * std::cos(tilt), 0, clear);
      tool.place_at(start, along);
      settle(touch, tool, 2);
      ASSERT_EQ(touch.pressing(), 0);
      // 25 mm in a dozen steps: several jaw radii each, far past the wall.
      int pressed = 0;
      for (int i = 1; i <= 12; ++i) {
        tool.move_to(start - Vector3d(0, 0, 0.025 * i / 12), along);
        step(touch, tool);
        const double height = touch.force(0).z();
        ASSERT_GE(height, 0) << "edge " << edge << " tilt " << tilt << " step " << i;
        pressed += height > 0;
        for (const TouchContact& c : touch.law().contacts())
          ASSERT_TRUE(c.touch == Touch::open || c.normal.z() < 0.1 + 1e-9)
              << "edge " << edge << " tilt " << tilt << " step " << i;
      }
      ASSERT_GE(pressed, 8) << "edge " << edge << " tilt " << tilt;
      for (int i = 0; i < 20; ++i) {  // held there, it goes on pushing out
        tool.stay();
        step(touch, tool);
        ASSERT_GT(touch.force(0).z(), 0);
      }
      for (int i = 250; i >= 0; --i) {
        tool.move_to(start - Vector3d(0, 0, 0.0001 * i), along);
        step(touch, tool);
        ASSERT_GE(touch.pressure(0).z(), 0) << "edge " << edge << " tilt " << tilt << " step " << i;
      }
      settle(touch, tool, 200);  // far nodes are brought up to date in turn
      EXPECT_EQ(touch.pressing(), 0);
      for (const Vector3d& x : touch.surface().positions()) ASSERT_LT(std::abs(x.z()), 1e-9);
    }
}

TEST(SegmentThrust, AJawPushedIntoATubeIsPushedBackOutOfTheWallThatItMet) {
  const ForcepsShape shape{.shaft_radius = 0.0025, .shaft_length = 0.05, .jaw_length = 0.014, .jaw_radius = 0.001};
  for (const auto& [friction, around] : {std::pair{0.0, 16}, {0.3, 16}, {0.0, 28}, {0.3, 28}}) {
    PatchTouch touch(testing::tube(around, 30 * around / 16, 0.0045, 0.05, 2e-3), friction, 3,
                     {.offset = 0.0005, .softness = {1e-4}});
    HandledTool tool = HandledTool::forceps(shape, 0.1);
    const Vector3d along = Vector3d(0.3, 1, -0.1).normalized(), start(0, -0.008, 0.0105);
    tool.place_at(start, along);
    settle(touch, tool, 2);
    ASSERT_EQ(touch.pressing(), 0);
    for (int i = 1; i <= 10; ++i) {  // as far as the axis of the tube, 1 mm a step
      tool.move_to(start - Vector3d(0, 0, 0.001 * i), along);
      step(touch, tool);
      const double height = touch.force(0).z();
      ASSERT_GE(height, 0) << "around " << around << " step " << i;
      ASSERT_TRUE(i <= 6 || height > 0);
    }
    for (int i = 100; i >= 0; --i) {
      tool.move_to(start - Vector3d(0, 0, 0.0001 * i), along);
      step(touch, tool);
      ASSERT_GE(touch.pressure(0).z(), 0) << "around " << around << " step " << i;
    }
    settle(touch, tool, 3);
    EXPECT_EQ(touch.pressing(), 0);
  }
}

}  // namespace
}  // namespace palpate
