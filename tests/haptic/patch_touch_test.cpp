// The patch rule: what a probe's tip feels of an organ whose triangles are twice as long as the tip's radius.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/haptic/patch_block.hpp"
#include "tests/tool/count_allocations.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

using testing::PatchBlock;

const Vector3d kAlong = Vector3d(2, 1, 0).normalized();

class PatchRule : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { block_ = std::make_unique<PatchBlock>(0); }
  static void TearDownTestSuite() { block_.reset(); }

  /// Under tools that come down from above, each by its own tip's place.
  static PressRig rig(double friction, int tools = 1, ContactRule rule = ContactRule::patch) {
    Scene scene = block_->scene;
    scene.contact.friction = friction;
    scene.contact.rule = rule;
    for (int t = 0; t < tools; ++t) scene.tools.push_back(PatchBlock::probe("probe" + std::to_string(t), 0.02 * t));
    return {scene, {block_->archive}};
  }
  static Vector3d at(double x, double y, double depth) { return {x, y, PatchBlock::kRadius - depth}; }
  static double hertz(double depth) {
    return 4.0 / 3 * PatchBlock::kYoung / (1 - PatchBlock::kPoisson * PatchBlock::kPoisson) *
           std::sqrt(PatchBlock::kRadius) * std::pow(depth, 1.5);
  }

  static std::unique_ptr<PatchBlock> block_;
};
std::unique_ptr<PatchBlock> PatchRule::block_;

// What a mesh converges to over Hertz (docs/contact.md); the rule of the mesh gives two to three times that.
TEST_F(PatchRule, IsNearTheConvergedForceAtAnyPlaceOfATriangle) {
  for (const auto& [depth, converged] :
       {std::pair{0.25 * PatchBlock::kRadius, 1.070}, {0.5 * PatchBlock::kRadius, 1.037}})
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {0.004, 0.001}, {0.006, 0.006}, {-0.011, 0.003}}) {
      PressRig rig = PatchRule::rig(0);
      rig.start(at(x, y, -0.001));
      for (int i = 1; i <= 100; ++i) rig.step(at(x, y, -0.001 + (depth + 0.001) * i / 100));
      EXPECT_NEAR(-rig.force().z() / hertz(depth), converged, 0.03 * converged) << x << " " << y << " " << depth;
    }
}

// Of a press far deeper than the tip is large the surface that the tip has passed lies far behind it.
TEST_F(PatchRule, ADeepPressAndItsReleaseHaveNoJump) {
  PressRig rig = PatchRule::rig(0.1);
  constexpr int kTicks = 350;
  const auto tip = [](int i) { return at(0.002, 0.001, -0.001 + 11 * PatchBlock::kRadius * i / kTicks); };
  rig.start(tip(0));
  Vector3d force = Vector3d::Zero();
  double most = 0, change = 0;
  for (int i = 0; i < 2 * kTicks; ++i) {
    rig.step(tip(i < kTicks ? i : 2 * kTicks - i));
    change = std::max(change, (rig.force() - force).norm());
    force = rig.force();
    most = std::max(most, force.norm());
    if (i == kTicks) {
      EXPECT_GT(force.norm(), 0.9 * most) << "the deeper, the harder it pushes";
    }
  }
  EXPECT_LT(change, 0.02 * most);
  EXPECT_LT(force.norm(), 1e-3 * most);
}

// Where no part of a tool touches by the mesh, nothing asks where its nodes are: they are not worked out, nor kept.
TEST_F(PatchRule, StateIsOfOneSizeWhateverTheMesh) {
  const auto bytes = [](const Archive& archive) {
    Scene scene = block_->scene;
    scene.tools.push_back(PatchBlock::probe("probe"));
    return HapticStep(scene, {archive}).state_size();
  };
  const auto& block = std::get<QuasiStaticSpec>(block_->scene.bodies[0]);
  const double side = 16 * PatchBlock::kRadius;
  const TetMesh coarser = make_block({-side / 2, -side / 2, -side / 2}, {side / 2, side / 2, 0}, {4, 4, 2});
  EXPECT_EQ(bytes(precompute(block, coarser)), bytes(block_->archive));
}

TEST_F(PatchRule, ASlideIsSmoothAndFrictionHoldsBack) {
  for (const double friction : {0.0, 0.3}) {
    SCOPED_TRACE(friction);
    PressRig rig = PatchRule::rig(friction);
    Vector3d tip = at(-0.012, -0.005, 0);
    rig.start(tip + Vector3d(0, 0, 0.001));
    const double depth = 0.5 * PatchBlock::kRadius;
    for (int i = 0; i <= 100; ++i) rig.step(tip - Vector3d(0, 0, depth * i / 100));
    tip.z() -= depth;
    double before = rig.force().norm(), sum = 0, of_squares = 0;
    int count = 0;
    for (int i = 0; i < 500; ++i) {
      tip += 5e-5 * kAlong;
      rig.step(tip);
      const double now = rig.force().norm(), along = rig.force().dot(kAlong);
      EXPECT_LT(std::abs(now - before), 0.005 * before) << i;
      EXPECT_GT(along, -0.002 * now) << "the tissue is drawn along, the tool held back";
      if (i > 100) {
        EXPECT_NEAR(along, friction * -rig.force().z(), 0.01 * now);
        sum += now;
        of_squares += now * now;
        ++count;
      }
      before = now;
    }
    const double mean = sum / count;
    EXPECT_LT(std::sqrt(of_squares / count - mean * mean), 0.005 * mean);
  }
}

TEST_F(PatchRule, TheForceComesAndGoesWithoutAStep) {
  PressRig rig = PatchRule::rig(0.3);
  rig.start(at(0.003, 0.002, -0.001));
  double before = 0;
  for (int i = 0; i <= 2000; ++i) {
    const double depth = -0.001 + 0.015 * std::pow(std::sin(M_PI * i / 2000), 2);
    rig.step(at(0.003, 0.002, depth));  // 2.3 radii deep
    const double now = rig.force().norm();
    EXPECT_LT(std::abs(now - before), 0.005) << i;
    if (depth <= 0) {
      EXPECT_EQ(now, 0) << i;
    }
    if (depth > 0.02 * PatchBlock::kRadius) {
      EXPECT_GT(now, 0) << i;  // the innermost squares are that far from the tip's own middle
    }
    before = now;
  }
  EXPECT_EQ(before, 0);
}

TEST_F(PatchRule, AHeldTipIsHeldByTheSameForce) {
  PressRig rig = PatchRule::rig(0.3);
  rig.start(at(0, 0, -0.001));
  for (int i = 0; i <= 100; ++i) rig.step(at(1e-5 * i, 0, 3e-5 * i));
  const Vector3d moving = rig.force();
  // The tissue is lifted by the shear of the step before.
  for (int i = 0; i < 3; ++i) rig.step(at(1e-3, 0, 3e-3));
  const Vector3d held = rig.force();
  EXPECT_LT((held - moving).norm(), 1e-4 * held.norm());
  for (int i = 0; i < 100; ++i) {
    rig.step(at(1e-3, 0, 3e-3));
    EXPECT_LT((rig.force() - held).norm(), 1e-6 * held.norm());
  }
}

// As on moving tissue: what they hold they carry, and the tip beside it presses nothing besides.
TEST_F(PatchRule, JawsThatHoldTheTissueAreAllThatTouchesIt) {
  Scene scene = block_->scene;
  scene.tools.push_back(PatchBlock::probe("probe0", 0));
  std::get<ProbeSpec>(scene.tools[0].end).jaws = ClosingJaws{.length = 0.02, .width = 0.03};
  PressRig rig(scene, {block_->archive});
  const auto jaws = [&](double depth, double grip) {
    ToolDofs dofs = tip_at(scene.tools[0], at(0.003, 0.002, depth));
    dofs.grip = grip;
    return std::array{dofs};
  };
  const auto pressed_besides = [&] {
    int count = 0;
    rig.haptic().part(0)->for_each_contact([&](const TouchContact& c) { count += !c.grasped; });
    return count;
  };
  rig.start(jaws(-0.001, 0.6));
  for (int i = 0; i <= 100; ++i) rig.step(jaws(3e-5 * i, 0.6));
  EXPECT_EQ(pressed_besides(), 1);
  for (int i = 0; i < 10; ++i) rig.step(jaws(3e-3, 0));
  EXPECT_EQ(pressed_besides(), 0);
  for (int i = 0; i <= 100; ++i) rig.step(jaws(3e-3 - 5e-5 * i, 0));
  EXPECT_LT(rig.haptic().force(0).z(), -0.01) << "what is held pulls back";
  for (int i = 0; i < 10; ++i) rig.step(jaws(3e-3, 0.6));
  EXPECT_EQ(pressed_besides(), 1) << "let go, the tip presses again";
}

TEST_F(PatchRule, AStabAtAMetreASecondFeelsWhatASlowPressFeels) {
  PressRig fast = PatchRule::rig(0.3), slow = PatchRule::rig(0.3), deep = PatchRule::rig(0.3);
  const auto tip = [](double depth) { return at(0.004, 0.001, depth); };
  const double full = fast.dt();  // [m] a tick at 1 m/s
  for (PressRig* rig : {&fast, &slow, &deep}) rig->start(tip(-0.01));
  for (int i = 1; i <= 700; ++i) deep.step(tip(-0.01 + 0.02 * full * i));
  const double most = deep.force().norm();
  double depth = -0.01;
  for (int i = 0; i < 28; ++i) {
    const double next = depth + (i < 14 ? full : -full);
    for (int k = 1; k <= 50; ++k) slow.step(tip(depth + (next - depth) * k / 50));
    fast.step(tip(next));
    depth = next;
    EXPECT_LT((fast.force() - slow.force()).norm(), 0.002 * most) << depth;
  }
  EXPECT_EQ(fast.force(), Vector3d::Zero());
}

TEST_F(PatchRule, TwoTipsThatComeCloseFeelEachOtherSmoothly) {
  PressRig rig = PatchRule::rig(0, 2);
  const auto tips = [&](double apart, double depth) {
    return std::array{tip_at(rig.scene().tools[0], at(-apart / 2, 0.001, depth)),
                      tip_at(rig.scene().tools[1], at(apart / 2, 0.001, depth))};
  };
  rig.start(tips(0.05, -0.001));
  for (int i = 0; i <= 100; ++i) rig.step(tips(0.05, 3e-5 * i));
  const double alone = rig.haptic().force(0).z();
  double before = alone;
  for (int i = 0; i < 1000; ++i) {
    rig.step(tips(0.05 - 0.037 * i / 1000, 3e-3));
    const double now = rig.haptic().force(0).z();
    EXPECT_LT(std::abs(now - before), 0.005 * alone) << i;
    before = now;
  }
  EXPECT_LT(before, 0.97 * alone) << "what the other one presses down it need not";
}

TEST_F(PatchRule, TheTissueIsWhereTheNodesForcesPutIt) {
  PressRig rig = PatchRule::rig(0.3);
  rig.start(at(0.002, 0.001, -0.001));
  for (int i = 0; i <= 100; ++i) rig.step(at(0.002 + 1e-5 * i, 0.001, 3e-5 * i));
  Vector3d sum = Vector3d::Zero();
  int contacts = 0;
  const BodyPart& part = *rig.haptic().part(0);
  part.for_each_force([&](int, int, const Vector3d& f) { sum += f; });
  part.for_each_contact([&](const TouchContact& c) {
    EXPECT_LT((c.force - sum).norm(), 1e-12);
    ++contacts;
  });
  EXPECT_EQ(contacts, 1);
  EXPECT_LT((sum - rig.force()).norm(), 1e-9);
  double deepest = 0;
  for (const Vector3d& u : rig.displacement()) deepest = std::min(deepest, u.z());
  EXPECT_LT(deepest, -3e-4);
}

TEST_F(PatchRule, GoesOnBitForBitFromASavedState) {
  const auto tip = [](int i) { return at(1e-5 * i, 4e-6 * i, 0.003 * std::sin(0.01 * i)); };
  PressRig rig = PatchRule::rig(0.3);
  rig.start(at(0, 0, -0.001));
  for (int i = 0; i < 120; ++i) rig.step(tip(i));
  const std::vector<std::uint8_t> state = rig.simulator().save();
  PressRig other = PatchRule::rig(0.3);
  other.start(at(0, 0, -0.001));
  other.simulator().restore(state);
  for (int i = 120; i < 240; ++i) {
    rig.step(tip(i));
    other.step(tip(i));
    ASSERT_EQ(rig.simulator().hash(), other.simulator().hash()) << i;
  }
}

TEST_F(PatchRule, AHapticNodeThatReturnsFeelsTheSameForce) {
  PressRig rig = PatchRule::rig(0.3);
  rig.start(at(0, 0, -0.001));
  for (int i = 0; i <= 100; ++i) rig.step(at(2e-5 * i, 0, 3e-5 * i));
  const Vector3d held = rig.force();
  std::vector<TouchContact> contacts;
  rig.haptic().part(0)->for_each_contact([&](const TouchContact& c) { contacts.push_back(c); });
  ASSERT_EQ(contacts.size(), 1u);
  PressRig anew = PatchRule::rig(0.3);
  anew.haptic().place(std::array{tip_at(anew.scene().tools[0], at(2e-3, 0, 3e-3))});
  HeldContact kept{.body = 0};
  for (int v = 0; v < 3; ++v) {
    kept.nodes[v] = contacts[0].anchor.nodes[v];
    kept.weights[v] = contacts[0].anchor.weights[v];
    kept.force[v] = contacts[0].force[v];
    kept.normal[v] = contacts[0].normal[v];
  }
  ASSERT_TRUE(anew.haptic().resume({.tool = 0, .contacts = {kept}}));
  anew.step(at(2e-3, 0, 3e-3));
  EXPECT_LT((anew.force() - held).norm(), 0.02 * held.norm());
}

TEST_F(PatchRule, AStepTakesNoMemory) {
  PressRig rig = PatchRule::rig(0.3, 2);
  const auto tips = [&](int i) {
    return std::array{tip_at(rig.scene().tools[0], at(1e-5 * i, 0, 2e-5 * i)),
                      tip_at(rig.scene().tools[1], at(0.02, 1e-5 * i, 2e-5 * i))};
  };
  rig.start(tips(-100));
  for (int i = -100; i < 50; ++i) rig.haptic().step(tips(i));
  const auto before = allocations();
  for (int i = 50; i < 200; ++i) rig.haptic().step(tips(i));
  EXPECT_EQ(allocations(), before);
}

}  // namespace
}  // namespace palpate
