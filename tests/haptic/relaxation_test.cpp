// What the hand feels of a quasi-static body that relaxes, by the rules that hold nodes.
#include <gtest/gtest.h>

#include "common/contact/creep.hpp"
#include "tests/haptic/block_scene.hpp"
#include "tests/haptic/hereditary.hpp"
#include "tests/tool/count_allocations.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.008, kTickSeconds = 1e-3;
const Relaxation kTwoTerms{{0.05, 0.4}, {0.3, 0.25}};
constexpr double kLeft = 0.45;  // of the modulus, in the end

/// A mesh, and where its top is pressed.
struct Ground {
  ContactRule rule;
  int cells;  ///< 8: triangles larger than the tip, which touches one point; 16: smaller ones
  Vector3d at;
};

class Relaxing : public ::testing::TestWithParam<Ground> {
 protected:
  static constexpr double kSticks = 10;  ///< friction under which points stay where they were first touched
  static PressRig rig(const std::optional<Relaxation>& relaxation, double friction = kSticks, int tools = 1) {
    const Ground& ground = GetParam();
    static const testing::BlockScene coarse(2, 8), fine(2, 16);
    Scene scene = ground.cells == 8 ? coarse.scene : fine.scene;
    scene.tools.resize(tools);
    scene.contact.rule = ground.rule;
    scene.contact.friction = friction;
    as<QuasiStaticSpec>(scene.bodies[0])->relaxation = relaxation;
    return {scene, ground.cells == 8 ? coarse.archives : fine.archives};
  }
  static Vector3d tip(double depth) { return GetParam().at + Vector3d(0, 0, kRadius - depth); }
  static double pressed(const PressRig& rig) { return -rig.force().z(); }

  /// Forces [N] at each tick of a press by depth(tick) [m].
  template <class Depth>
  static std::vector<double> forces(PressRig rig, int ticks, Depth&& depth) {
    std::vector<double> all;
    rig.start(tip(-0.001));
    for (int n = 0; n < ticks; ++n) {
      rig.step(tip(depth(n)));
      all.push_back(pressed(rig));
    }
    return all;
  }
};

TEST_P(Relaxing, AHeldPressRelaxesByTheClosedForm) {
  const auto down = [](int) { return 0.003; };
  const std::vector<double> elastic = forces(rig({}), 600, down);
  const std::vector<double> felt = forces(rig(kTwoTerms), 600, down);
  ASSERT_GT(elastic[0], 0.02);
  const std::vector<double> expected = testing::relaxed(kTwoTerms, elastic, kTickSeconds);
  for (std::size_t n = 0; n < felt.size(); ++n) EXPECT_NEAR(felt[n], expected[n], 1e-5 * elastic[0]) << n;
  EXPECT_NEAR(felt[0], elastic[0], 0.01 * elastic[0]);
  EXPECT_NEAR(felt.back(), (1 - 0.3 - 0.25 * (1 - std::exp(-0.6 / 0.4))) * elastic[0], 1e-3 * elastic[0]);
}

TEST_P(Relaxing, AGrowingPressIsTheHereditaryIntegralOfTheElasticOne) {
  const auto down = [](int n) { return 0.004 * (n + 1) / 400; };
  const std::vector<double> elastic = forces(rig({}), 400, down);
  const std::vector<double> felt = forces(rig(kTwoTerms), 400, down);
  const std::vector<double> expected = testing::relaxed(kTwoTerms, elastic, kTickSeconds);
  for (std::size_t n = 0; n < felt.size(); ++n) EXPECT_NEAR(felt[n], expected[n], 1e-5 * elastic.back()) << n;
  EXPECT_LT(felt.back(), 0.8 * elastic.back());
}

TEST_P(Relaxing, TimesFarFromThoseOfThePressDoNotCount) {
  const auto down = [](int n) { return 0.004 * std::min(1.0, (n + 1) / 200.0); };
  const std::vector<double> elastic = forces(rig({}), 300, down);
  const std::vector<double> fast = forces(rig(Relaxation{{1e6}, {0.6}}), 300, down);
  const std::vector<double> slow = forces(rig(Relaxation{{1e-7, 1e-6}, {0.4, 0.2}}), 300, down);
  for (std::size_t n = 0; n < elastic.size(); ++n) {
    EXPECT_NEAR(fast[n], elastic[n], 1e-6 * elastic.back()) << n;
    EXPECT_NEAR(slow[n], 0.4 * elastic[n], 1e-3 * elastic.back()) << n;
  }
}

// Recovery: with the forces that were felt, u = U (f + sum of gain s) / f_elastic at each node.
TEST_P(Relaxing, WhatIsLetGoCreepsBackAndPullsAtNothing) {
  PressRig elastic = rig({}), relaxing = rig(kTwoTerms);
  for (PressRig* r : {&elastic, &relaxing}) r->start(tip(-0.001));
  std::vector<double> share;
  for (int n = 0; n < 300; ++n) {
    for (PressRig* r : {&elastic, &relaxing}) r->step(tip(0.003));
    share.push_back(pressed(relaxing) / pressed(elastic));
  }
  const std::vector<Vector3d> whole = elastic.displacement();
  for (int n = 0; n < 700; ++n) {
    relaxing.step(tip(-0.02));
    ASSERT_EQ(relaxing.force().norm(), 0) << n;
    share.push_back(0);
    if (n % 100 != 4) continue;
    double left = 0;
    for (const CreepTerm& term : creep_terms(kTwoTerms)) {
      double lag = 0, before = 0;
      for (const double f : share) {
        const double steps = kTickSeconds / term.time, mean = -std::expm1(-steps) / steps;
        lag = std::exp(-steps) * lag + (mean - std::exp(-steps)) * before + (1 - mean) * f;
        before = f;
      }
      left += term.gain * lag;
    }
    const std::vector<Vector3d> now = relaxing.displacement();
    double largest = 0, worst = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      largest = std::max(largest, whole[i].norm());
      worst = std::max(worst, (now[i] - left * whole[i]).norm());
    }
    EXPECT_LT(worst, 1e-3 * largest) << n;
    EXPECT_GT(left, n < 300 ? 0.1 : 0.0);
  }
}

TEST_P(Relaxing, ATipInTheDentFeelsNothingUntilTheTissueHasComeBackToIt) {
  PressRig rig = Relaxing::rig(kTwoTerms, 0);
  rig.start(tip(-0.001));
  for (int n = 0; n < 400; ++n) rig.step(tip(0.004));
  int touched = -1;
  double before = 0;
  for (int n = 0; n < 3000; ++n) {
    rig.step(tip(0.001));
    const double now = pressed(rig);
    ASSERT_GE(now, -1e-9);
    if (now > 0 && touched < 0) touched = n;
    if (n > 0) {
      EXPECT_LT(now - before, 0.002) << n << ": it comes without a jump";
    }
    before = now;
  }
  EXPECT_GT(touched, 20);
  EXPECT_GT(before, 0);
}

TEST_P(Relaxing, ReleaseAndRestGiveNothingBackForNothing) {
  PressRig rig = Relaxing::rig(kTwoTerms);
  rig.start(tip(-0.001));
  double work = 0, before = 0, depth = 0;  // [J] of the hand
  for (int n = 0; n < 4000; ++n) {
    const double next = 0.002 * (1 - std::cos(0.011 * n)) * (1 + 0.3 * std::sin(0.0031 * n));
    rig.step(tip(next));
    work += 0.5 * (before + pressed(rig)) * (next - depth);
    before = pressed(rig);
    depth = next;
    EXPECT_GT(work, -1e-9) << n;
  }
  EXPECT_GT(work, 1e-6) << "what is lost in the tissue";
}

TEST_P(Relaxing, GoesOnBitForBitFromASavedState) {
  const auto tips = [](const PressRig& rig, int n) {
    const double s = 1e-3 * n;
    return std::array{
        tip_at(rig.scene().tools[0], {-0.02 + 0.03 * s, 0.01 * std::sin(5 * s), kRadius - 0.004 * std::sin(9 * s)}),
        tip_at(rig.scene().tools[1], {0.02, 0.02 * s, kRadius - 0.003 * std::sin(7 * s)})};
  };
  PressRig one = rig(kTwoTerms, 0.3, 2), other = rig(kTwoTerms, 0.3, 2);
  for (PressRig* r : {&one, &other}) r->start(tips(*r, 0));
  double largest = 0;
  for (int n = 0; n < 600; ++n) one.step(tips(one, n));
  other.simulator().restore(one.simulator().save());
  for (int n = 600; n < 1200; ++n) {
    one.step(tips(one, n));
    other.step(tips(other, n));
    ASSERT_EQ(one.simulator().hash(), other.simulator().hash()) << n;
    largest = std::max(largest, one.force().norm());
  }
  EXPECT_GT(largest, 0.02);
}

TEST_P(Relaxing, AStepTakesNoMemory) {
  PressRig rig = Relaxing::rig(kTwoTerms);
  const auto at = [&](int n) {
    const double s = 1e-3 * n;
    return std::array{tip_at(rig.scene().tools[0], {-0.03 + 0.03 * s, 0, kRadius - 0.003 * std::sin(12 * s)})};
  };
  rig.start(at(0));
  for (int n = 0; n < 200; ++n) rig.haptic().step(at(n));
  const long before = allocations();
  for (int n = 200; n < 1500; ++n) rig.haptic().step(at(n));
  EXPECT_EQ(allocations(), before);
}

INSTANTIATE_TEST_SUITE_P(Rules, Relaxing,
                         ::testing::Values(Ground{ContactRule::barycentric, 8, {0, 0, 0}},
                                           Ground{ContactRule::barycentric, 8, {0.004, 0.003, 0}},
                                           Ground{ContactRule::alpha, 8, {0.004, 0.003, 0}},
                                           Ground{ContactRule::barycentric, 16, {0.001, 0.002, 0}}),
                         [](const auto& info) {
                           return std::string(word_of(info.param.rule)) + std::to_string(info.param.cells) + "_" +
                                  std::to_string(info.index);
                         });

}  // namespace
}  // namespace palpate
