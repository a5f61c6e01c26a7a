// The patch rule on tissue that relaxes.
#include <gtest/gtest.h>

#include "tests/haptic/hereditary.hpp"
#include "tests/haptic/patch_block.hpp"
#include "tests/tool/count_allocations.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

using testing::PatchBlock;
constexpr double kDt = 1e-3;
const Relaxation kRelaxation{{0.05, 0.5}, {0.3, 0.3}};

class RelaxingPatch : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    block_ = std::make_unique<PatchBlock>(1);
    block_->scene.tools.push_back(PatchBlock::probe("probe"));
  }
  static void TearDownTestSuite() { block_.reset(); }

  static PressRig rig(const std::optional<Relaxation>& relaxation, double friction = 0) {
    Scene scene = block_->scene;
    scene.contact.friction = friction;
    as<QuasiStaticSpec>(scene.bodies[0])->relaxation = relaxation;
    return {scene, {block_->archive}};
  }
  static Vector3d at(double x, double y, double depth) { return {x, y, PatchBlock::kRadius - depth}; }
  static Vector3d at(double depth) { return at(0.003, 0.002, depth); }
  static Vector3d above() { return at(0, 0, -0.002); }
  static double hertz(double depth) {
    return 4.0 / 3 * PatchBlock::kYoung / (1 - PatchBlock::kPoisson * PatchBlock::kPoisson) *
           std::sqrt(PatchBlock::kRadius) * std::pow(std::max(depth, 0.0), 1.5);
  }
  template <class Depth>
  static std::vector<double> forces(PressRig rig, int ticks, Depth&& depth) {
    std::vector<double> all;
    rig.start(above());
    for (int n = 0; n < ticks; ++n) {
      rig.step(at(depth(n)));
      all.push_back(-rig.force().z());
    }
    return all;
  }

  static std::unique_ptr<PatchBlock> block_;
};
std::unique_ptr<PatchBlock> RelaxingPatch::block_;

// Lee & Radok 1960: while the contact area grows, F(t) is the hereditary integral over Hertz's force.
TEST_F(RelaxingPatch, ASphereThatGoesDownFollowsLeeAndRadok) {
  for (const int ticks : {50, 400}) {
    SCOPED_TRACE(ticks);
    const auto down = [=](int n) { return 0.5 * PatchBlock::kRadius * (n + 1) / ticks; };
    const std::vector<double> elastic = forces(rig({}), ticks, down), felt = forces(rig(kRelaxation), ticks, down);
    std::vector<double> of_hertz;
    for (int n = 0; n < ticks; ++n) of_hertz.push_back(hertz(down(n)));
    const std::vector<double> expected = testing::relaxed(kRelaxation, elastic, kDt);
    const std::vector<double> theory = testing::relaxed(kRelaxation, of_hertz, kDt);
    for (int n = 0; n < ticks; ++n) EXPECT_NEAR(felt[n], expected[n], 0.002 * elastic.back()) << n;
    for (int n = ticks / 10; n < ticks; ++n)
      EXPECT_NEAR(felt[n] / elastic[n], theory[n] / of_hertz[n], 0.02 * theory[n] / of_hertz[n]) << n;
    EXPECT_LT(felt.back(), 0.9 * elastic.back());
    EXPECT_NEAR(felt.back() / theory.back(), 1.06, 0.04) << "what the tensors leave of Hertz";
  }
}

TEST_F(RelaxingPatch, AHeldPressRelaxesByTheClosedForm) {
  const auto down = [](int n) { return n < 20 ? 0.5 * PatchBlock::kRadius * (n + 1) / 20 : 0.5 * PatchBlock::kRadius; };
  const std::vector<double> elastic = forces(rig({}), 1500, down), felt = forces(rig(kRelaxation), 1500, down);
  const std::vector<double> expected = testing::relaxed(kRelaxation, elastic, kDt);
  for (std::size_t n = 0; n < felt.size(); ++n) EXPECT_NEAR(felt[n], expected[n], 0.001 * elastic.back()) << n;
  EXPECT_NEAR(felt.back(), (0.4 + 0.3 * std::exp(-1.49 / 0.5)) * elastic.back(), 0.002 * elastic.back());
}

TEST_F(RelaxingPatch, AStuckShearRelaxesAsThePressureDoes) {
  PressRig elastic = rig({}, 1), relaxing = rig(kRelaxation, 1);
  for (PressRig* r : {&elastic, &relaxing}) r->start(above());
  for (int n = 1; n <= 1000; ++n) {
    const Vector3d tip = at(0.003 + 1e-5 * std::min(n, 20), 0.002, 0.003 * std::min(1.0, n / 20.0));
    for (PressRig* r : {&elastic, &relaxing}) r->step(tip);
  }
  const double share = relaxing.force().z() / elastic.force().z();
  EXPECT_NEAR(relaxing.force().x() / elastic.force().x(), share, 0.02 * share);
  EXPECT_GT(std::abs(elastic.force().x()), 0.02 * std::abs(elastic.force().z()));
}

TEST_F(RelaxingPatch, PressHoldSlideAndReleaseHaveNoJump) {
  for (const double friction : {0.0, 0.3}) {
    SCOPED_TRACE(friction);
    PressRig rig = RelaxingPatch::rig(kRelaxation, friction);
    rig.start(above());
    Vector3d before = Vector3d::Zero();
    double largest = 0, jump = 0;
    for (int n = 0; n < 2500; ++n) {
      const double down = 0.5 * PatchBlock::kRadius * std::clamp(std::min(n / 200.0, (2300 - n) / 200.0), -0.2, 1.0);
      const double aside = 2e-5 * std::clamp(n - 700, 0, 1000);
      rig.step(at(-0.01 + aside, 0.002 + 0.4 * aside, down));
      jump = std::max(jump, (rig.force() - before).norm());
      before = rig.force();
      largest = std::max(largest, before.norm());
      EXPECT_LT(before.z(), 1e-12) << n << ": it never pulls";
    }
    EXPECT_EQ(before.norm(), 0);
    EXPECT_LT(jump, 0.015 * largest);
  }
}

// Forward and back over the same line: fresh tissue is stiffer than what has been pressed before.
TEST_F(RelaxingPatch, TissueThatHasBeenPressedIsSofterUntilItHasComeBack) {
  const auto over = [](PressRig& rig, double from, double to) {
    double sum = 0;
    for (int n = 0; n < 100; ++n) rig.step(at(from, 0, -0.001 + 0.003 * (n + 1) / 100));
    for (int n = 0; n < 200; ++n) {
      rig.step(at(from + (to - from) * n / 200, 0, 0.002));
      sum -= rig.force().z() / 200;
    }
    for (int n = 0; n < 50; ++n) rig.step(at(to, 0, -0.002));
    return sum;
  };
  PressRig rig = RelaxingPatch::rig(Relaxation{{2}, {0.6}});
  rig.start(above());
  const double first = over(rig, -0.006, 0.006), second = over(rig, -0.006, 0.006);
  for (int n = 0; n < 60000; ++n) rig.haptic().step(std::array{tip_at(rig.scene().tools[0], at(0, 0, -0.002))});
  const double rested = over(rig, -0.006, 0.006);
  EXPECT_LT(second, 0.98 * first);
  EXPECT_NEAR(rested, first, 0.001 * first);
}

TEST_F(RelaxingPatch, GoesOnBitForBitFromASavedState) {
  const auto tip = [](int n) { return at(-0.01 + 4e-5 * n, 1e-5 * n, 0.003 * std::sin(0.012 * n)); };
  PressRig one = rig(kRelaxation, 0.3), other = rig(kRelaxation, 0.3);
  for (PressRig* r : {&one, &other}) r->start(above());
  for (int n = 0; n < 350; ++n) one.step(tip(n));
  other.simulator().restore(one.simulator().save());
  for (int n = 350; n < 700; ++n) {
    one.step(tip(n));
    other.step(tip(n));
    ASSERT_EQ(one.simulator().hash(), other.simulator().hash()) << n;
  }
}

TEST_F(RelaxingPatch, AStepTakesNoMemory) {
  PressRig rig = RelaxingPatch::rig(kRelaxation, 0.3);
  rig.start(above());
  const auto step = [&](int n) {
    const Vector3d tip = at(-0.01 + 4e-5 * n, 1e-5 * n, 0.003 * std::sin(0.03 * n));
    rig.haptic().step(std::array{tip_at(rig.scene().tools[0], tip)});
  };
  for (int n = 0; n < 120; ++n) step(n);
  const long before = allocations();
  for (int n = 120; n < 600; ++n) step(n);
  EXPECT_EQ(allocations(), before);
}

}  // namespace
}  // namespace palpate
