// What a local contact model may tell of moving tissue whose elements the haptic node knows.
#include "common/models/moving/tissue_limits.hpp"

#include <gtest/gtest.h>

#include "tests/haptic/local_models_for_tests.hpp"
#include "tests/sim/played_scenes.hpp"

namespace palpate {
namespace {

using testing::add_contact;
using testing::empty_model;

/// A block 30 mm high below a probe.
class TissueLimitsTest : public ::testing::Test {
 protected:
  TissueLimitsTest() { haptic_.start(std::array{played_.inputs(0)[0].dofs}); }

  /// What the surface near (0, 0) tells at rest, with this stiffness at each node.
  LocalContactModel at_rest(const Eigen::Vector3d& tip, double stiffness) const {
    LocalContactModel m = empty_model(tool(), tip, 0, seq_);
    const SurfaceMap& surface = played_.archives[0].surface;
    for (std::uint32_t n = 0; n < 3; ++n)
      m.nodes.push_back({0, n, testing::plain(surface.position[n]), {}, testing::isotropic(stiffness)});
    m.triangles.push_back({0, 1, 2});
    return m;
  }
  const Tool& tool() const { return played_.scene.tools[0]; }
  /// [N] on the tool after so many steps with this model as the newest in each.
  double feel(LocalContactModel m, const Eigen::Vector3d& tip, int steps) {
    for (int k = 0; k < steps; ++k) {
      m.seq = ++seq_;
      m.tool_step = haptic_.steps();
      EXPECT_TRUE(haptic_.consume(m));
      haptic_.step(std::array{palpate::tip_at(tool(), tip)});
    }
    return haptic_.force(0).norm();
  }

  testing::PlayedScene played_ = testing::cut_block();
  HapticStep haptic_{played_.scene, played_.archives};
  std::uint64_t seq_ = 1;
};

TEST_F(TissueLimitsTest, APressOnAToolInFreeAirIsAlmostNothing) {
  const Eigen::Vector3d above(-0.01, 0, 0.037);
  feel(at_rest(above, 10), above, 20);
  LocalContactModel m = at_rest(above, 10);
  add_contact(m, above - Eigen::Vector3d(0, 0, 0.006), {0, 0, -10}, 0);
  const double force = feel(m, above, 200);
  EXPECT_LT(force, 0.5);
  EXPECT_TRUE(haptic_.flags(0) & implausible_force) << "and it is said";
}

TEST_F(TissueLimitsTest, WhatTheMotionOfTheToolExplainsIsFelt) {
  const Eigen::Vector3d above(-0.01, 0, 0.037);
  feel(at_rest(above, 10), above, 20);
  LocalContactModel m = at_rest(above, 10);
  const Eigen::Vector3d inside(-0.01, 0, 0.031);
  m = at_rest(inside, 10);
  add_contact(m, inside - Eigen::Vector3d(0, 0, 0.006), {0, 0, -0.3}, 50);
  EXPECT_NEAR(feel(m, inside, 200), 0.3, 1e-9);
  EXPECT_FALSE(haptic_.flags(0) & implausible_force);
}

TEST_F(TissueLimitsTest, TissueThatIsPressedAndCutIsNeverLimited) {
  for (const auto& played :
       {testing::cut_block(), testing::cut_block<SpringMassSpec>(), testing::cut_block<HybridSpec>()}) {
    sim::Simulator simulator(played.scene, played.archives);
    simulator.start(played.inputs(0));
    double largest = 0;
    for (int i = 1; i < 700; ++i) {
      simulator.step(played.inputs(i));
      largest = std::max(largest, simulator.tool(0).force.norm());
      ASSERT_FALSE(simulator.tool(0).flags & implausible_force) << i;
    }
    EXPECT_GT(largest, 0.05) << "something is felt";
  }
}

TEST_F(TissueLimitsTest, AModelThatCannotBeOfThisTissueIsRefused) {
  const Eigen::Vector3d above(-0.01, 0, 0.037);
  const auto taken = [&](auto&& change) {
    LocalContactModel m = at_rest(above, 10);
    add_contact(m, above, {0, 0, -0.1}, 10);
    change(m);
    return haptic_.consume(m);
  };
  EXPECT_TRUE(taken([](auto&) {}));
  EXPECT_FALSE(taken([](auto& m) { m.nodes[0].node = 100'000; })) << "a node that the body lacks";
  EXPECT_FALSE(taken([](auto& m) { m.nodes[0].position[0] = 1; })) << "a metre away";
  EXPECT_FALSE(taken([](auto& m) { m.contacts[0].position[0] = 1; }));
  EXPECT_FALSE(taken([](auto& m) { m.nodes[0].body = 1; }));
}

}  // namespace
}  // namespace palpate
