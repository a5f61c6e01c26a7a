#include "tools/stability/watch.hpp"

#include <gtest/gtest.h>

#include "tools/rig/duct.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/rig/kinds.hpp"
#include "tools/stability/press.hpp"

/// What looks on sees what must not occur.
namespace palpate::stability {
namespace {

TEST(StabilityWatch, ACatheterThatIsNoNumberHasFailedHoweverItGoesOn) {
  CatheterSettings s;
  s.shape.tail = {0, 0, -0.1};
  s.shape.tip = {0, 0, 0};
  s.young = 1e7;
  CatheterBody body(s, nullptr);
  CatheterWatch watch;
  std::array jaw{Eigen::Isometry3d::Identity()};
  body.grasp(0, jaw[0], body.nearest({0, 0, 0}), 0, 1e-4);
  body.step({}, jaw);
  watch.look(body);
  EXPECT_EQ(watch.result(0).outcome, Outcome::stable);
  jaw[0].translation().x() = NAN;
  body.step({}, jaw);
  watch.look(body);
  const CatheterBody sound(s, nullptr);
  watch.look(sound);
  EXPECT_EQ(watch.result(0).outcome, Outcome::failed);
}

TEST(StabilityWatch, ADuctIsMovedByTheCatheterThatLeansOnIt) {
  Duct duct;
  CatheterSettings s;
  s.shape.tail = {0, 0, -0.08};
  s.shape.tip = {0, 0, 0.02};
  s.shape.inside = "duct";
  s.young = 3e7;
  CatheterBody body(s, &duct.wall());
  std::array jaw{Eigen::Isometry3d::Identity()};
  body.grasp(0, jaw[0], body.nearest({0, 0, 0}), 0.004, 1e-4);
  for (int i = 0; i < 200; ++i) {
    jaw[0].translation().y() = 2.5e-5 * i;
    duct.tick(body, jaw);
  }
  EXPECT_GT(body.wall_contacts(), 0);
  EXPECT_GT(duct.energy(), 1e-9);
}

TEST(StabilityWatch, ADeeperPressOfMovingTissueHasTheLargerForce) {
  const Result shallow = press_tissue(moving_block_scene(), small_block_mesh(), 0.002, 200),
               deep = press_tissue(moving_block_scene(), small_block_mesh(), 0.004, 200);
  EXPECT_GT(shallow.max_force, 1e-3);
  EXPECT_GT(deep.max_force, 1.5 * shallow.max_force);
  EXPECT_GT(deep.energy_growth, -1e-12);
}

/// A press of which a share of its work is counted.
Result watched(double share) {
  PressRig rig(moving_block_scene(), {precompute_on(moving_block_scene().bodies[0], small_block_mesh())});
  TissueWatch watch;
  for (int i = 0; i < 200; ++i) {
    rig.press(Eigen::Vector3d(0, 0, 0.0261 - 2.5e-5 * i));
    watch.look(rig.organ(), share * rig.force().dot(Eigen::Vector3d(0, 0, -2.5e-5)));
  }
  return watch.result();
}

TEST(StabilityWatch, TissueWithMoreEnergyThanTheWorkHasFailed) {
  EXPECT_EQ(watched(1).outcome, Outcome::stable) << watched(1).note;
  const Result gained = watched(0.1);
  EXPECT_EQ(gained.outcome, Outcome::failed);
  EXPECT_NE(gained.note.find("energy beyond the work"), std::string::npos) << gained.note;
  EXPECT_EQ(watched(0).outcome, Outcome::failed) << "no work at all";
}

TEST(StabilityWatch, TissueThatIsFlungFartherThanHalfItsDiagonalHasFailed) {
  Scene scene = moving_block_scene();
  moving_block_of(scene).dynamic.gravity = {0, 0, 1e4};
  PressRig rig(scene, {precompute_on(scene.bodies[0], small_block_mesh())});
  TissueWatch watch;
  for (int i = 0; i < 200; ++i) {
    rig.press(Eigen::Vector3d(0, 0, 1));
    watch.look(rig.organ(), 1e3);
  }
  EXPECT_EQ(watch.result().outcome, Outcome::failed);
  EXPECT_NE(watch.result().note.find("reach over the diagonal"), std::string::npos) << watch.result().note;
}

/// Moving tissue whose two contacts, once its first models have come in, pull against each other with `force` [N], ten
/// millimetres apart.
Result pulled_by_a_couple(double force) {
  Scene scene = block_scene();
  scene.bodies[0] = as_kind<TensorMassSpec>(block_of(scene));
  scene.passivity.controller = false;
  HapticStep haptic(scene, std::vector<Archive>(1));
  const ToolDofs dofs = tip_at(scene.tools[0], {0, 0, 0.008});
  haptic.start(std::array{dofs});
  Watch watch;
  for (std::uint64_t i = 0; i < 110; ++i) {
    LocalContactModel m;
    m.run = 1, m.seq = i + 1, m.tool_run = 1, m.tool_step = i;
    m.yaw = dofs.yaw, m.pitch = dofs.pitch, m.depth = dofs.depth, m.roll = dofs.roll, m.grip = dofs.grip;
    for (const double side : {1.0, -1.0})
      if (i > 60)
        m.contacts.push_back(
            {0, 0, {0.005 * side, 0, 0}, {0, 0, -side}, {0, 0, -side * force}, {0, 0, 0, 0, 0, 0, 0, 0, 0}});
    haptic.consume(m);
    haptic.step(std::array{dofs});
    watch.look(haptic);
  }
  return watch.result();
}

TEST(StabilityWatch, AHandThatGainsMoreThanTheReserveIsNeverCalledStable) {
  HapticStep haptic(block_scene(), {precompute_on(block_scene().bodies[0], block_mesh())});
  haptic.start(std::array{tip_at(block_scene().tools[0], {0, 0, 0.008})});
  haptic.step(std::array{tip_at(block_scene().tools[0], {0, 0, 0.008})});
  Watch watch;
  watch.look(haptic);
  EXPECT_EQ(watch.result().outcome, Outcome::stable);
  EXPECT_EQ(watch.result(-1e-9).outcome, Outcome::failed) << "a reserve below what it has gained";
}

TEST(StabilityWatch, ATorqueIsLimitedThoughForcesCancelOut) {
  EXPECT_EQ(pulled_by_a_couple(1).outcome, Outcome::stable);
  const Result couple = pulled_by_a_couple(1e7);
  EXPECT_LT(couple.max_force, 1);
  EXPECT_EQ(couple.outcome, Outcome::regularised) << couple.note;
}

}  // namespace
}  // namespace palpate::stability
