#include "common/models/moving/local_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "common/sim/haptic_step.hpp"
#include "tests/haptic/local_models_for_tests.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::add_contact;
using testing::add_square;
using testing::empty_model;

constexpr double kBallRadius = 0.008;

/// A tool above moving tissue whose deform node is the test itself.
class LocalBodyTest : public ::testing::Test {
 protected:
  explicit LocalBodyTest(double friction = 0) : scene_(testing::moving_block_scene(kBallRadius)) { restart(friction); }

  void restart(double friction) {
    scene_.contact.friction = friction;
    scene_.passivity.controller = false;  // poses jump here, and the forces of a model are meant
    haptic_ = std::make_unique<HapticStep>(scene_, std::vector<Archive>(1));
    haptic_->start(std::array{tip_at(tool(), far)});
    step_ = 0;
  }
  const Tool& tool() const { return scene_.tools[0]; }
  LocalContactModel model(const Vector3d& tip) { return empty_model(tool(), tip, step_, ++seq_); }
  /// One step with the tip at p; returns the force on the tool.
  Vector3d feel(const Vector3d& p) {
    haptic_->step(std::array{tip_at(tool(), p)});
    ++step_;
    return haptic_->force(0);
  }
  /// Steps at p, with this model renewed each time so that it never ages, until the force has faded in.
  Vector3d feel_settled(const Vector3d& p, LocalContactModel m) {
    for (int i = 0; i < 60; ++i) {
      m.tool_step = step_, m.seq = ++seq_;
      EXPECT_TRUE(haptic_->consume(m));
      feel(p);
    }
    return haptic_->force(0);
  }

  const Vector3d far{0, 0, 0.1};
  Scene scene_;
  std::unique_ptr<HapticStep> haptic_;
  std::uint64_t step_ = 0, seq_ = 0;
};

TEST_F(LocalBodyTest, WithoutAModelNothingIsFelt) {
  EXPECT_EQ(feel({0, 0, -0.01}).norm(), 0);
  EXPECT_EQ(haptic_->flags(0), 0u);
}

TEST_F(LocalBodyTest, AHeldPlaceAnswersMotionByItsStiffnessAndNeverPulls) {
  const Vector3d pressed{0, 0, 0};
  LocalContactModel m = model(pressed);
  add_contact(m, {0, 0, -kBallRadius}, {0, 0, -1.5}, 300);
  EXPECT_NEAR(feel_settled(pressed, m).z(), 1.5, 1e-9);
  EXPECT_NEAR(feel_settled({0, 0, -0.002}, m).z(), 1.5 + 300 * 0.002, 1e-9);
  EXPECT_NEAR(feel_settled({0, 0, 0.004}, m).z(), 1.5 - 300 * 0.004, 1e-9);
  EXPECT_EQ(feel_settled({0, 0, 0.006}, m).norm(), 0) << "beyond 5 mm the contact would pull";
  EXPECT_NEAR(feel_settled({0, 0, 0.004}, m).z(), 1.5 - 300 * 0.004, 1e-9) << "and it comes back";
}

TEST_F(LocalBodyTest, AContactThatIsNotAtItsToolIsNotFelt) {
  for (const bool grasped : {false, true})
    for (const double aside : {0.0, 0.2}) {
      LocalContactModel m = model({0, 0, 0});
      add_contact(m, {aside, 0, -kBallRadius}, {0, 0, -1.5}, 300);
      m.contacts[0].grasped = grasped;
      EXPECT_NEAR(feel_settled({0, 0, 0}, m).z(), aside > 0 ? 0 : 1.5, 1e-9) << grasped;
      EXPECT_EQ((haptic_->flags(0) & implausible_force) != 0, aside > 0) << grasped;
    }
}

TEST_F(LocalBodyTest, WhatJawsHoldPullsAsWell) {
  LocalContactModel m = model({0, 0, 0});
  add_contact(m, {0, 0, 0}, {0, 0, 0}, 200);
  m.contacts[0].grasped = 1;
  EXPECT_NEAR(feel_settled({0, 0, 0.003}, m).z(), -0.6, 1e-9);
  EXPECT_NEAR(feel_settled({0.001, 0, 0}, m).x(), -0.2, 1e-4);
}

TEST_F(LocalBodyTest, FrictionIsAtMostItsShareOfThePressure) {
  restart(0.5);
  LocalContactModel m = model({0, 0, 0});
  add_contact(m, {0, 0, -kBallRadius}, {0, 0, -1}, 200);
  const Vector3d sticks = feel_settled({0.001, 0, 0}, m);
  EXPECT_NEAR(sticks.x(), -0.2, 0.01) << "the shaft turns a little about its trocar";
  const Vector3d slides = feel_settled({0.02, 0, 0}, m);
  const double pressure = slides.z();
  EXPECT_GT(pressure, 0.3);
  EXPECT_NEAR(slides.x(), -0.5 * pressure, 1e-9);
  restart(0);
  EXPECT_EQ(feel_settled({0.001, 0, 0}, m).x(), 0);
}

TEST_F(LocalBodyTest, TheTorqueIsThatOfTheForceAtTheTouchingPoint) {
  restart(0.9);
  LocalContactModel m = model({0, 0, 0});
  add_contact(m, {0, 0, -kBallRadius}, {0.3, -0.2, -1}, 0);
  feel_settled({0, 0, 0}, m);
  const Vector3d expected = Vector3d(0, 0, -kBallRadius).cross(Vector3d(-0.3, 0.2, 1));
  EXPECT_LT((haptic_->torque(0) - expected).norm(), 1e-12);
}

TEST_F(LocalBodyTest, ASphereThatHeldNothingIsPushedOutOfTheNearSurface) {
  LocalContactModel m = model(far);
  add_square(m, 0, 250);
  EXPECT_EQ(feel_settled({0.01, 0.02, kBallRadius + 1e-4}, m).norm(), 0);
  for (const double depth : {1e-3, 5e-3, 7.9e-3, 8.1e-3, 1.2e-2}) {
    const Vector3d force = feel_settled({0.01, 0.02, kBallRadius - depth}, m);
    EXPECT_NEAR(force.z(), 250 * depth, 1e-9) << depth;
    EXPECT_LT(force.head<2>().norm(), 1e-12);
  }
  EXPECT_EQ(feel_settled({0.1, 0.02, kBallRadius - 5e-3}, m).norm(), 0) << "beside the surface";
}

TEST_F(LocalBodyTest, StiffnessIsThatOfTheTriangleWhereItIsTouched) {
  LocalContactModel m = model(far);
  add_square(m, 0, 0);
  for (int n = 0; n < 4; ++n) m.nodes[n].stiffness = testing::isotropic(100 + 3000 * (m.nodes[n].position[0] + 0.05));
  EXPECT_NEAR(feel_settled({0.01, 0.02, kBallRadius - 2e-3}, m).z(), (100 + 3000 * 0.06) * 2e-3, 1e-9);
  EXPECT_NEAR(feel_settled({-0.03, -0.02, kBallRadius - 2e-3}, m).z(), (100 + 3000 * 0.02) * 2e-3, 1e-9);
}

TEST_F(LocalBodyTest, AroundAConvexEdgeTheForceTurnsButNeverJumpsNorAttracts) {
  // A wedge: one square up, one facing +x, sharing an edge; the tip goes round it at constant depth.
  LocalContactModel m = model(far);
  const auto node = [&](double x, double y, double z) {
    m.nodes.push_back({0, 0, {x, y, z}, {}, testing::isotropic(200)});
  };
  node(-0.05, -0.05, 0), node(0, -0.05, 0), node(0, 0.05, 0), node(-0.05, 0.05, 0), node(0, -0.05, -0.05),
      node(0, 0.05, -0.05);
  m.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i <= 90; ++i) {
    const double angle = i * std::numbers::pi / 180;
    const Vector3d outward{std::sin(angle), 0, std::cos(angle)};
    const Vector3d force = feel_settled((kBallRadius - 2e-3) * outward, m);
    EXPECT_NEAR(force.norm(), 0.4, 1e-6) << i;
    EXPECT_GT(force.dot(outward), 0.399) << i;
    EXPECT_LT((force - last).norm(), i > 0 ? 0.02 : 0.5) << i;
    last = force;
  }
}

TEST_F(LocalBodyTest, NodesMoveOnWithTheirVelocityForAWhile) {
  LocalContactModel m = model(far);
  add_square(m, -2e-3, 1000, {0, 0, 0.1});
  ASSERT_TRUE(haptic_->consume(m));
  const Vector3d p{0.01, 0.02, kBallRadius};
  for (int i = 0; i < 10; ++i) feel(p);
  EXPECT_EQ(haptic_->force(0).norm(), 0) << "after 9 ms the surface is still 1.1 mm below";
  for (int i = 10; i < 100; ++i) {
    const double rise = 0.1 * std::min(1e-3 * i, LocalBody::kExtrapolated) - 2e-3;
    EXPECT_NEAR(feel(p).z(), rise > 0 ? 1000 * rise : 0, 1e-9) << i;
  }
}

TEST_F(LocalBodyTest, AHeldPlaceIsNotFeltTwice) {
  LocalContactModel m = model({0, 0, 0.006});
  add_contact(m, {0, 0, -0.002}, {0, 0, -1}, 300);
  add_square(m, 0, 250);  // the sphere reaches 2 mm below this surface
  EXPECT_NEAR(feel_settled({0, 0, 0.006}, m).z(), 1, 1e-9);
  m.contacts.clear();
  EXPECT_NEAR(feel_settled({0, 0, 0.006}, m).z(), 250 * 2e-3, 1e-9);
}

TEST_F(LocalBodyTest, ContactsThatDidNotPressAreNoHold) {
  LocalContactModel m = model({0, 0, 0.006});
  add_contact(m, {0, 0, -0.002}, {0, 0, 0.1}, 300);
  EXPECT_EQ(feel_settled({0, 0, 0.005}, m).norm(), 0);
}

TEST_F(LocalBodyTest, AModelThatIsTooOldFadesWithinFiftyMillisecondsAndSaysSo) {
  LocalContactModel m = model({0, 0, 0});
  add_contact(m, {0, 0, -kBallRadius}, {0, 0, -2}, 300);
  feel_settled({0, 0, 0}, m);
  const std::uint64_t newest = step_ - 1;
  while (step_ <= newest + 150) {
    EXPECT_NEAR(feel({0, 0, 0}).z(), 2, 1e-9);
    EXPECT_EQ(haptic_->flags(0) & stale_model, 0u);
  }
  double last = 2;
  for (int i = 0; i < 50; ++i) {
    const double force = feel({0, 0, 0}).z();
    EXPECT_LT(force, last);
    EXPECT_GT(force, last - 0.021 * 2) << "no step that a hand would feel";
    EXPECT_NE(haptic_->flags(0) & stale_model, 0u);
    last = force;
  }
  EXPECT_LT(last, 1e-12);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(feel({0, 0, 0}).norm(), 0);
  EXPECT_NE(haptic_->flags(0) & stale_model, 0u) << "for as long as there should be a force";
  EXPECT_EQ(haptic_->flags(0) & fault, 0u);
  m.tool_step = step_;
  m.seq = ++seq_;
  ASSERT_TRUE(haptic_->consume(m));
  EXPECT_NEAR(feel({0, 0, 0}).z(), 0.02 * 2, 1e-9) << "it comes back as smoothly";
  for (int i = 0; i < 50; ++i) feel({0, 0, 0});
  EXPECT_NEAR(haptic_->force(0).z(), 2, 1e-9);
}

TEST_F(LocalBodyTest, ATouchThatBeginsFromNothingIsFeltAtOnce) {
  LocalContactModel m;
  for (int i = 0; i < 60; ++i) {  // the first model of all has come in
    m = model({0, 0, 0.02});
    add_square(m, 0, 250);
    ASSERT_TRUE(haptic_->consume(m));
    feel({0, 0, 0.02});
  }
  EXPECT_NEAR(feel({0, 0, 0.006}).z(), 250 * 2e-3, 1e-9);
  EXPECT_EQ(haptic_->flags(0) & stale_model, 0u);
  for (int i = 0; i < 250; ++i) feel({0, 0, 0.02});
  EXPECT_EQ(haptic_->flags(0) & stale_model, 0u) << "away from the tissue nothing is missing";
}

TEST_F(LocalBodyTest, WhileNoModelComesAToolGoesThroughWhatStandsThereWithoutAJump) {
  for (int i = 0; i < 60; ++i) {
    LocalContactModel m = model({0, 0, 0.02});
    add_square(m, 0, 250);
    add_square(m, -4e-3, 250);
    m.triangles[2] = {4, 6, 5}, m.triangles[3] = {4, 7, 6};  // the other side of a flap, which faces down
    ASSERT_TRUE(haptic_->consume(m));
    feel({0, 0, kBallRadius - 1e-3});
  }
  Vector3d last = haptic_->force(0);
  ASSERT_NEAR(last.z(), 0.25, 1e-9);
  for (int i = 1; i <= 140; ++i) {  // 14 mm
    const Vector3d force = feel({0, 0, kBallRadius - 1e-3 - 1e-4 * i});
    EXPECT_LT((force - last).norm(), i <= 5 ? 0.026 : 0.351 / 20) << i;
    last = force;
  }
}

TEST_F(LocalBodyTest, AToolThatIsFirstToldOfFromWithinTheTissueIsPushedOutSlowly) {
  LocalContactModel m = model({0, 0, 0.006});
  ASSERT_TRUE(haptic_->consume(m));  // the tissue does not know of it yet
  feel({0, 0, 0.006});
  double before = 0;
  for (int i = 0; i < 60; ++i) {
    m = model({0, 0, 0.006});
    add_square(m, 0, 250);
    ASSERT_TRUE(haptic_->consume(m));
    const double now = feel({0, 0, 0.006}).z();
    EXPECT_LE(now - before, 2.01 * 250 * 2e-3 / 50);
    before = now;
  }
  EXPECT_NEAR(before, 250 * 2e-3, 1e-9);
}

TEST_F(LocalBodyTest, ARunGoesOnBitForBitFromASavedState) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  HapticStep copy(scene_, std::vector<Archive>(1));
  std::vector<std::uint8_t> state(haptic_->state_size());
  const auto tip = [](int i) {
    return Vector3d(0.01 * std::sin(0.02 * i), 0.003 * std::cos(0.05 * i), 0.006 + 0.005 * std::sin(0.03 * i));
  };
  int touched = 0;
  for (int i = 0; i < 1200; ++i) {
    const bool twice = i >= 600;
    if (i % 7 == 0 && (i < 700 || i > 1000)) {
      LocalContactModel m = model(tip(i));
      add_square(m, 1e-3 * any(random), 300 + 50 * any(random), {0, 0, 0.1 * any(random)});
      if (i % 3) add_contact(m, tip(i) + Vector3d(0, 0, -kBallRadius), {0.1 * any(random), 0.1, -1 + any(random)}, 300);
      ASSERT_TRUE(haptic_->consume(m));
      ASSERT_TRUE(!twice || copy.consume(m));
    }
    if (i == 600) {
      haptic_->save(state);
      copy.restore(state);
      copy.consume(0, haptic_->local(0).model());
    }
    const Vector3d force = feel(tip(i));
    touched += force.norm() > 0;
    if (!twice) continue;
    copy.step(std::array{tip_at(tool(), tip(i))});
    ASSERT_EQ(force, copy.force(0)) << i;
    ASSERT_EQ(haptic_->torque(0), copy.torque(0)) << i;
    ASSERT_EQ(haptic_->flags(0), copy.flags(0)) << i;
  }
  EXPECT_GT(touched, 400);
}

TEST_F(LocalBodyTest, ADamagedStateIsRefused) {
  std::vector<std::uint8_t> state(haptic_->state_size());
  LocalContactModel m = model({0, 0, 0});
  add_square(m, 0, 100);
  ASSERT_TRUE(haptic_->consume(m));
  haptic_->save(state);
  haptic_->restore(state);
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::uint8_t> bad = state;
    for (int k = 0; k < 40; ++k) bad[random() % bad.size()] = static_cast<std::uint8_t>(random());
    try {
      haptic_->restore(bad);
      ASSERT_TRUE(feel({0, 0, 0.004}).allFinite());
    } catch (const std::runtime_error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

TEST_F(LocalBodyTest, ModelsThatDoNotFitAreRefusedAndTheOldOneStays) {
  LocalContactModel m = model({0, 0, 0});
  add_contact(m, {0, 0, -kBallRadius}, {0, 0, -2}, 300);
  feel_settled({0, 0, 0}, m);
  const auto refuse = [&](auto&& change) {
    LocalContactModel bad = model({0, 0, 0});
    add_contact(bad, {0, 0, -kBallRadius}, {0, 0, -9}, 300);
    add_square(bad, 0, 100);
    change(bad);
    EXPECT_FALSE(haptic_->consume(bad));
  };
  refuse([](auto& b) { b.tool = 1; });
  refuse([](auto& b) { b.contacts[0].body = 1; });
  refuse([](auto& b) { b.nodes[3].body = 7; });
  refuse([](auto& b) { b.triangles[1].c = 4; });
  refuse([](auto& b) { b.contacts[0].force[2] = std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_NEAR(feel({0, 0, 0}).z(), 2, 1e-9);
}

TEST_F(LocalBodyTest, HugeButFiniteModelsEndInAFaultAtMostAndNeverInNonsense) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 500; ++i) {
    LocalContactModel m = model({0, 0, 0.004});
    const double size = std::pow(10, 12 * std::abs(any(random)));
    add_contact(m, {0, 0, -0.004}, {size * any(random), 0, -size}, size);
    add_square(m, 0, size, {0, 0, size * any(random)});
    ASSERT_TRUE(haptic_->consume(m));
    const Vector3d force = feel({0, 0, 0.004});
    ASSERT_TRUE(force.allFinite()) << i;
    ASSERT_LE(force.norm(), 100 * (1 + 1e-12));
  }
}

TEST_F(LocalBodyTest, AQuasiStaticBodyInTheSameSceneIsFeltAsBefore) {
  const testing::BlockScene alone;
  Scene both = alone.scene;
  both.bodies.push_back(scene_.bodies[0]);
  std::vector<Archive> archives = alone.archives;
  archives.emplace_back();
  HapticStep a(alone.scene, alone.archives), b(both, archives);
  EXPECT_FALSE(a.has_moving_tissue());
  EXPECT_TRUE(b.has_moving_tissue());
  const Tool& t = alone.scene.tools[0];
  a.start(std::array{tip_at(t, {0, 0, 0.02})});
  b.start(std::array{tip_at(t, {0, 0, 0.02})});
  for (int i = 0; i <= 200; ++i) {
    const auto dofs = std::array{tip_at(t, {0, 0, 0.02 - 1e-4 * i})};
    a.step(dofs);
    b.step(dofs);
    ASSERT_EQ(a.force(0), b.force(0)) << i;
  }
  EXPECT_GT(a.force(0).norm(), 0.1);
  // What the moving body adds, it adds: here at the other body's index.
  LocalContactModel m = empty_model(t, {0, 0, 0}, 200);
  m.contacts.push_back({1, 0, {0, 0, -kBallRadius}, {0, 0, -1}, {0, 0, -1}, testing::isotropic(0)});
  ASSERT_TRUE(b.consume(m));
  m.contacts[0].body = 0;
  EXPECT_FALSE(b.consume(m)) << "the first body is not dynamic";
  for (int i = 0; i < 60; ++i) {
    a.step(std::array{tip_at(t, {0, 0, 0})});
    b.step(std::array{tip_at(t, {0, 0, 0})});
  }
  EXPECT_NEAR((b.force(0) - a.force(0)).z(), 1, 1e-12);
}

}  // namespace
}  // namespace palpate
