#include "common/models/modal_shell/modal_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/models/quasi_static/quasi_static_body.hpp"
#include "common/sim/step_messages.hpp"
#include "tests/haptic/duct_scene.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::duct_tip_at;
using testing::DuctScene;

constexpr double kTop = DuctScene::kRadius + DuctScene::kThickness / 2;  // [m] of the duct's outer side above its axis

/// A duct under one probe that comes down on the middle of it.
struct Pressed {
  DuctScene duct;
  std::unique_ptr<HapticStep> haptic;

  const ModalBody& wall() const { return dynamic_cast<const ModalBody&>(*haptic->part(0)); }

  explicit Pressed(int modes, bool residual = true) : duct(modes) {
    duct.add_probe();
    as<ShellSpec>(duct.scene.bodies[0])->shell.residual = residual;
    haptic = std::make_unique<HapticStep>(duct.scene, duct.archives);
    haptic->start(std::array{at(0.002)});
  }
  ToolDofs at(double above) const {
    return duct_tip_at(duct.scene.tools[0], {0, kTop + 0.003 + above, DuctScene::kLength / 2});
  }
  void move(double from, double to, int steps) {
    for (int i = 1; i <= steps; ++i) haptic->step(std::array{at(from + (to - from) * i / steps)});
  }
  double force() const { return haptic->force(0).y(); }
};

TEST(ModalBody, FeelsNothingUntilItIsTouchedOnItsOuterSide) {
  Pressed p(20);
  p.move(0.002, 5e-5, 100);
  EXPECT_EQ(p.haptic->force(0).norm(), 0);
  p.move(5e-5, -3e-4, 100);
  EXPECT_GT(p.force(), 0);
}

TEST(ModalBody, AtRestUnderATipItPushesAsAQuasiStaticBodyDoes) {
  Pressed modal(30);
  modal.move(0.002, -0.001, 300);
  for (int i = 0; i < 1500; ++i) modal.move(-0.001, -0.001, 1);

  // The same compliance without inertia. Its tools touch the middle surface: they are thicker by half the wall.
  DuctScene still(30);
  Tool& tool = still.add_probe();
  std::get<ProbeSpec>(tool.end).radius += DuctScene::kThickness / 2;
  QuasiStaticSpec body;
  static_cast<MeshedSpec&>(body) = *as<MeshedSpec>(still.scene.bodies[0]);
  still.scene.bodies[0] = body;
  still.scene.contact.rule = ContactRule::barycentric;
  HapticStep quasi_static(still.scene, still.archives);
  quasi_static.start(std::array{modal.at(0.002)});
  for (int i = 0; i <= 300; ++i) quasi_static.step(std::array{modal.at(0.002 - 1e-5 * i)});
  EXPECT_GT(modal.force(), 0.005);
  EXPECT_NEAR(modal.force(), quasi_static.force(0).y(), 0.03 * modal.force());
}

TEST(ModalBody, WithoutResidualFlexibilityFewModesAreTooStiff) {
  Pressed with(8, true), without(8, false);
  for (Pressed* p : {&with, &without}) {
    p->move(0.002, -0.001, 300);
    for (int i = 0; i < 1000; ++i) p->move(-0.001, -0.001, 1);
  }
  EXPECT_GT(without.force(), 1.15 * with.force());
}

TEST(ModalBody, HeldStillTheForceSettlesAndDoesNotAlternate) {
  Pressed p(30);
  p.move(0.002, -0.001, 100);
  for (int i = 0; i < 500; ++i) p.move(-0.001, -0.001, 1);
  double last = p.force(), largest = 0;
  for (int i = 0; i < 50; ++i) {
    p.move(-0.001, -0.001, 1);
    largest = std::max(largest, std::abs(p.force() - last));
    last = p.force();
  }
  EXPECT_GT(last, 0.005);
  EXPECT_LT(largest, 1e-3 * last);
}

TEST(ModalBody, LetGoItSwingsOutAndItsEnergyFalls) {
  Pressed p(30);
  p.move(0.002, -0.0015, 300);
  p.move(-0.0015, 0.05, 2);  // away at once
  double before = p.wall().energy();
  EXPECT_GT(before, 0);
  for (int i = 0; i < 200; ++i) {
    p.move(0.05, 0.05, 1);
    const double now = p.wall().energy();
    EXPECT_LE(now, before * (1 + 1e-12));
    before = now;
  }
  for (int i = 0; i < 3000; ++i) p.move(0.05, 0.05, 1);
  EXPECT_LT(p.wall().energy(), 1e-9);
}

TEST(ModalBody, TappingDoesNotFeedItsEnergy) {
  Pressed p(30);
  p.move(0.002, -0.001, 100);
  for (int i = 0; i < 500; ++i) p.move(-0.001, -0.001, 1);
  const double held = p.wall().energy();
  double largest = 0, down = -0.001;
  for (int tap = 0; tap < 200; ++tap) {
    const double up = tap % 2 ? 0.0005 : 0.002;
    p.move(down, up, 3 + tap % 5);
    p.move(up, down, 3 + tap % 7);
    largest = std::max(largest, p.wall().energy());
  }
  // A tip that comes at up to 1 m/s throws the wall about, but no more from tap to tap.
  EXPECT_LT(largest, 60 * held);
}

TEST(ModalBody, ARestoredStateGoesOnBitForBit) {
  Pressed a(20), b(20);
  a.move(0.002, -0.001, 150);
  std::vector<std::uint8_t> state(a.haptic->state_size());
  a.haptic->save(state);
  b.haptic->restore(state);
  for (int i = 0; i < 200; ++i) {
    const double above = -0.001 + 0.0015 * std::sin(0.05 * i);
    a.move(above, above, 1);
    b.move(above, above, 1);
    ASSERT_EQ(a.haptic->force(0), b.haptic->force(0)) << i;
  }
}

TEST(ModalBody, ItsShownFieldIsTheFullOne) {
  // u = Phi X' + C f at the touched nodes is where the contact law has put them.
  Pressed p(12);
  p.move(0.002, -0.001, 300);
  for (int i = 0; i < 800; ++i) p.move(-0.001, -0.001, 1);
  const Archive& archive = p.duct.archives[0];
  const Compliance<double> compliance(archive, Compliance<double>::Rows::surface);
  std::vector<double> coordinates(p.wall().modes());
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * archive.surface.size());
  p.wall().show(coordinates.data(), [&](int node, const Vector3d& f) {
    for (int axis = 0; axis < 3; ++axis)
      u += f[axis] * Eigen::Map<const Eigen::VectorXd>(compliance.column(node, axis), u.size());
  });
  for (std::size_t m = 0; m < coordinates.size(); ++m)
    u += coordinates[m] * Eigen::Map<const Eigen::VectorXd>(archive.modal->shape.data() + u.size() * m, u.size());
  int touching = 0;
  for (const TouchContact& c : p.haptic->law(0).contacts()) {
    if (c.touch == Touch::open || c.face) continue;
    const int node = c.anchor.nodes[0];
    ++touching;
    EXPECT_LT((archive.surface.position[node] + u.segment<3>(3 * node) - (c.position - 1e-4 * c.force)).norm(), 2e-6);
  }
  EXPECT_GT(touching, 0);
}

// A haptic node that comes back knows the contacts, but not how far the wall had given way.
TEST(ModalBody, TakenUpByAnotherHapticNodeItPushesAsItDid) {
  Pressed before(30), after(30);
  before.move(0.002, -0.001, 300);
  for (int i = 0; i < 1500; ++i) before.move(-0.001, -0.001, 1);
  StepRecord record;
  prepare_record(*before.haptic, record);
  fill_record(*before.haptic, std::array{DeviceSample{before.at(-0.001), 0}}, 1, 0, record);
  ContactState kept;
  describe_contacts(record, 0, kept);
  after.haptic->place(std::array{after.at(-0.001)});
  ASSERT_TRUE(after.haptic->resume(kept));
  for (int i = 0; i < 300; ++i) {
    after.move(-0.001, -0.001, 1);
    ASSERT_NEAR(after.force(), before.force(), 0.1 * before.force()) << i;
  }
}

}  // namespace
}  // namespace palpate
