#include "common/sim/haptic_step.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/haptic/block_scene.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::BlockScene;

class HapticStepTest : public ::testing::Test {
 protected:
  static const BlockScene& one_tool() {
    static const BlockScene scene;
    return scene;
  }
  /// Elements smaller than the tip, so that vertices carry the contact.
  static const BlockScene& fine() {
    static const BlockScene scene(1, 16);
    return scene;
  }
  static const BlockScene& two_tools() {
    static const BlockScene scene(2);
    return scene;
  }
  /// Moves the only tool's tip from a to b in so many steps.
  static void sweep(HapticStep& haptic, const Tool& tool, const Vector3d& a, const Vector3d& b, int steps) {
    for (int i = 1; i <= steps; ++i) haptic.step(std::array{tip_at(tool, a + (b - a) * i / steps)});
  }
  static constexpr double kRadius = 0.008;
};

TEST_F(HapticStepTest, ATipAboveTheSurfaceFeelsNothing) {
  const BlockScene& s = one_tool();
  HapticStep haptic(s.scene, s.archives);
  haptic.start(std::array{tip_at(s.scene.tools[0], {0, 0, 0.05})});
  sweep(haptic, s.scene.tools[0], {0, 0, 0.05}, {0.01, 0, kRadius + 1e-4}, 200);
  EXPECT_EQ(haptic.force(0).norm(), 0);
}

TEST_F(HapticStepTest, APressPushesTheToolBackAndReleasesWithoutAdhesion) {
  const BlockScene& s = one_tool();
  const Tool& tool = s.scene.tools[0];
  HapticStep haptic(s.scene, s.archives);
  const Vector3d above{0, 0, 0.02}, pressed{0, 0, kRadius - 0.005};
  haptic.start(std::array{tip_at(tool, above)});
  sweep(haptic, tool, above, pressed, 300);
  const double force = haptic.force(0).z();
  EXPECT_GT(force, 0.05);
  EXPECT_LT(haptic.force(0).head<2>().norm(), 0.2 * force);
  double least = force;
  for (int i = 1; i <= 300; ++i) {
    haptic.step(std::array{tip_at(tool, pressed + (above - pressed) * i / 300)});
    least = std::min(least, haptic.force(0).z());
  }
  EXPECT_GE(least, -1e-9);
  EXPECT_EQ(haptic.force(0).norm(), 0);
  EXPECT_TRUE(haptic.law(0).contacts().empty() || haptic.law(0).contacts()[0].force.isZero(0));
}

TEST_F(HapticStepTest, TheTouchedSurfaceLiesOnTheTip) {
  const BlockScene& s = one_tool();
  const Tool& tool = s.scene.tools[0];
  HapticStep haptic(s.scene, s.archives);
  haptic.start(std::array{tip_at(tool, {0.003, 0.004, 0.02})});
  const Vector3d end{0.003, 0.004, kRadius - 0.004};
  sweep(haptic, tool, {0.003, 0.004, 0.02}, end, 200);
  for (int i = 0; i < 5; ++i) haptic.step(std::array{tip_at(tool, end)});
  int touching = 0;
  for (const TouchContact& c : haptic.law(0).contacts())
    if (c.touch != Touch::open) {
      ++touching;
      EXPECT_NEAR((c.position - end).norm(), kRadius, 2e-5);
    }
  EXPECT_GT(touching, 0);
}

TEST_F(HapticStepTest, NoSpeedTunnelsThroughTheSurface) {
  const BlockScene& s = one_tool();
  const Tool& tool = s.scene.tools[0];
  for (double jump : {0.002, 0.009, 0.02, 0.04, 0.06}) {
    HapticStep haptic(s.scene, s.archives);
    const Vector3d above{0.0037, -0.0021, 0.0095};
    haptic.start(std::array{tip_at(tool, above)});
    haptic.step(std::array{tip_at(tool, above - Vector3d(0, 0, jump))});
    EXPECT_GT(haptic.force(0).z(), 0) << "jump " << jump;
    EXPECT_TRUE(haptic.force(0).allFinite());
    for (int i = 0; i < 20; ++i) haptic.step(std::array{tip_at(tool, above - Vector3d(0, 0, jump))});
    EXPECT_TRUE(haptic.force(0).allFinite());
    if (jump > 0.05) continue;  // out of the other side
    EXPECT_GT(haptic.force(0).z(), 0) << "jump " << jump << ", 20 steps on";
  }
}

TEST_F(HapticStepTest, AToolThatStartsInTheOrganIsRefusedByName) {
  const BlockScene& s = one_tool();
  HapticStep haptic(s.scene, s.archives);
  try {
    haptic.start(std::array{tip_at(s.scene.tools[0], {0, 0, -0.01})});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("tool 'probe0' starts inside body 'block'"), std::string::npos)
        << error.what();
  }
}

TEST_F(HapticStepTest, FrictionHoldsASidewaysPushAndWithoutItTheTipSlides) {
  double without = 0;
  for (double friction : {0.0, 0.5}) {
    BlockScene s = fine();
    s.scene.contact.friction = friction;
    const Tool& tool = s.scene.tools[0];
    HapticStep haptic(s.scene, s.archives);
    const Vector3d above{-0.01, 0, 0.02}, pressed{-0.01, 0, kRadius - 0.004}, aside{0.01, 0, kRadius - 0.004};
    haptic.start(std::array{tip_at(tool, above)});
    sweep(haptic, tool, above, pressed, 200);
    sweep(haptic, tool, pressed, aside, 1000);
    const Vector3d f = haptic.force(0);
    EXPECT_GT(f.z(), 0.05);
    if (friction == 0) {
      EXPECT_LT(std::abs(f.x()), 0.1 * f.z());
      without = f.x();
    } else {
      EXPECT_LT(f.x(), without - 0.1 * f.z());
      EXPECT_GT(f.x(), -0.7 * f.z());  // mu, and the slope of the dent
    }
  }
}

TEST_F(HapticStepTest, AClosedMotionGivesNoEnergyToTheHand) {
  const Tool& tool = fine().scene.tools[0];
  for (double friction : {0.0, 0.3, 1.0}) {
    BlockScene scene = fine();
    scene.scene.contact.friction = friction;
    HapticStep haptic(scene.scene, scene.archives);
    Vector3d last{0, 0, 0.012};
    haptic.start(std::array{tip_at(tool, last)});
    double taken = 0, largest = 0;  // work of the hand against the tissue
    Vector3d last_force = Vector3d::Zero();
    for (int i = 1; i <= 4000; ++i) {
      const double t = i / 4000.0, turn = 2 * std::numbers::pi * t;
      const Vector3d p{0.012 * std::sin(2 * turn), 0.008 * std::sin(3 * turn),
                       0.012 - 0.01 * std::sin(std::numbers::pi * t)};
      haptic.step(std::array{tip_at(tool, p)});
      taken += -0.5 * (haptic.force(0) + last_force).dot(p - last);
      largest = std::max(largest, taken);
      last = p;
      last_force = haptic.force(0);
    }
    EXPECT_GT(taken, -0.02 * largest) << "friction " << friction;
  }
}

TEST_F(HapticStepTest, RestoredStateGoesOnBitForBit) {
  for (const ContactRule rule : {ContactRule::barycentric, ContactRule::alpha}) {
    BlockScene s = two_tools();
    s.scene.contact.rule = rule;
    for (Tool& tool : s.scene.tools) std::get<ProbeSpec>(tool.end).radius = 0.005;
    const auto input = [&](int i) {
      const double t = 1e-3 * i;
      const double z = 0.0075 - 0.012 * std::min(1.0, 2 * t) + 0.004 * std::sin(9 * t);
      return std::array{tip_at(s.scene.tools[0], {-0.01 + 0.02 * t, 0.004 * std::sin(5 * t), z}, t),
                        tip_at(s.scene.tools[1], {0.008, -0.01 + 0.015 * t, 0.9 * z}, -t)};
    };
    HapticStep original(s.scene, s.archives), copy(s.scene, s.archives);
    original.start(input(0));
    std::vector<std::uint8_t> state(original.state_size());
    double largest = 0;
    for (int i = 1; i < 1500; ++i) {
      if (i == 400) {
        original.save(state);
        copy.restore(state);
      }
      original.step(input(i));
      if (i < 400) continue;
      largest = std::max(largest, original.force(0).norm());
      copy.step(input(i));
      for (int t = 0; t < 2; ++t) {
        ASSERT_EQ(original.force(t), copy.force(t)) << word_of(rule) << " step " << i;
        ASSERT_EQ(original.torque(t), copy.torque(t)) << word_of(rule) << " step " << i;
      }
    }
    EXPECT_GT(largest, 0.05);
  }
}

TEST_F(HapticStepTest, TwoToolsAtOnePlaceStayFiniteAndBounded) {
  BlockScene s = two_tools();
  HapticStep haptic(s.scene, s.archives);
  const Vector3d above{0.01, 0, 0.02}, pressed{0.01, 0, kRadius - 0.004};
  haptic.start(std::array{tip_at(s.scene.tools[0], above), tip_at(s.scene.tools[1], above)});
  for (int i = 1; i <= 200; ++i) {
    const Vector3d p = above + (pressed - above) * i / 200;
    haptic.step(std::array{tip_at(s.scene.tools[0], p), tip_at(s.scene.tools[1], p - Vector3d(0, 0, 1e-3))});
    ASSERT_TRUE(haptic.force(0).allFinite() && haptic.force(1).allFinite());
    ASSERT_LT((haptic.force(0) + haptic.force(1)).norm(), 5.0);
  }
  EXPECT_GT(haptic.force(0).z() + haptic.force(1).z(), 0.05);
}

TEST_F(HapticStepTest, ANonFinitePoseRampsTheForceToZeroWithinFiveMilliseconds) {
  const BlockScene& s = one_tool();
  const Tool& tool = s.scene.tools[0];
  HapticStep haptic(s.scene, s.archives);
  const Vector3d above{0, 0, 0.02}, pressed{0, 0, kRadius - 0.005};
  haptic.start(std::array{tip_at(tool, above)});
  sweep(haptic, tool, above, pressed, 300);
  const double force = haptic.force(0).norm();
  ToolDofs broken = tip_at(tool, pressed);
  broken.depth = std::nan("");
  for (int i = 0; i < 5; ++i) {
    haptic.step(std::array{broken});
    EXPECT_TRUE(haptic.flags(0) & fault);
    EXPECT_LT(haptic.force(0).norm(), force);
  }
  EXPECT_LT(haptic.force(0).norm(), 1e-12);
  haptic.step(std::array{tip_at(tool, pressed)});
  EXPECT_LT(haptic.force(0).norm(), 1e-12) << "a fault stays";
}

TEST_F(HapticStepTest, TheShaftTouchesToo) {
  BlockScene s = one_tool();
  Tool& tool = s.scene.tools[0];
  tool.pivot = {0.2, 0, 0.02};
  tool.axis = {-1, 0, 0};
  tool.up = {0, 0, 1};
  HapticStep haptic(s.scene, s.archives);
  // The tip passes beyond the far edge, the shaft comes down on the block's middle.
  const Vector3d before{-0.12, 0, 0.03};
  haptic.start(std::array{tip_at(tool, before)});
  sweep(haptic, tool, before, {-0.12, 0, -0.035}, 400);
  EXPECT_GT(haptic.force(0).z(), 0.01);
  EXPECT_GT(haptic.torque(0).norm(), 1e-4);
}

TEST(HapticJaws, HoldQuasiStaticTissueUntilTheyOpen) {
  BlockScene block;
  std::get<ProbeSpec>(block.scene.tools[0].end).jaws = ClosingJaws{0.02, 0.03, 0.1};
  HapticStep haptic(block.scene, block.archives);
  const auto at = [&](double height, double grip) {
    ToolDofs d = tip_at(block.scene.tools[0], {0, 0, height});
    d.grip = grip;
    return std::array{d};
  };
  haptic.start(at(0.02, 0.6));
  const double touch = 0.0075;
  for (int i = 0; i < 200; ++i) haptic.step(at(0.02 + (touch - 0.02) * i / 199, 0.6));
  for (int i = 0; i < 10; ++i) haptic.step(at(touch, 0.05));
  for (int i = 0; i < 200; ++i) haptic.step(at(touch + 0.005 * i / 199, 0.05));
  EXPECT_LT(haptic.force(0).z(), -0.05) << "the tissue pulls at the jaws";
  std::vector<std::uint8_t> state(haptic.state_size());
  haptic.save(state);
  HapticStep other(block.scene, block.archives);
  other.restore(state);
  for (int i = 0; i < 20; ++i) {
    haptic.step(at(touch + 0.005, 0.05));
    other.step(at(touch + 0.005, 0.05));
    EXPECT_EQ(haptic.force(0), other.force(0));
  }
  for (int i = 0; i < 200; ++i) haptic.step(at(0.03, 0.6));
  EXPECT_TRUE(haptic.force(0).isZero(0));
}

}  // namespace
}  // namespace palpate
