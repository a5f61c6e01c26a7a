#include "common/sim/simulator.hpp"

#include <gtest/gtest.h>

#include "tests/sim/played_scenes.hpp"

namespace palpate::sim {
namespace {

using Eigen::Vector3d;
using testing::PlayedScene;

/// Steps [from, to) of the scene's motion.
void play(Simulator& simulator, const PlayedScene& played, int from, int to) {
  for (int i = from; i < to; ++i) simulator.step(played.inputs(i));
}

struct Case {
  const char* name;
  PlayedScene (*make)();
  int steps;
};

class EveryKindOfTissue : public ::testing::TestWithParam<Case> {};

TEST_P(EveryKindOfTissue, GivesTheSameBitsTwiceInEachStep) {
  const PlayedScene played = GetParam().make();
  Simulator one(played.scene, played.archives), other(played.scene, played.archives);
  for (Simulator* s : {&one, &other}) s->start(played.inputs(0));
  double largest = 0;
  for (int i = 0; i < GetParam().steps; ++i) {
    for (Simulator* s : {&one, &other}) s->step(played.inputs(i));
    ASSERT_EQ(one.hash(), other.hash()) << "step " << i;
    ASSERT_TRUE(one.tool(0).force.allFinite());
    largest = std::max(largest, one.tool(0).force.norm());
  }
  EXPECT_GT(largest, 0.01);
}

TEST_P(EveryKindOfTissue, GoesOnFromASavedStateBitForBit) {
  const PlayedScene played = GetParam().make();
  Simulator saved(played.scene, played.archives), restored(played.scene, played.archives);
  saved.start(played.inputs(0));
  const int half = GetParam().steps / 2 + 3;
  play(saved, played, 0, half);
  restored.restore(saved.save());
  EXPECT_EQ(restored.steps(), saved.steps());
  for (int i = half; i < GetParam().steps; ++i) {
    for (Simulator* s : {&saved, &restored}) s->step(played.inputs(i));
    ASSERT_EQ(restored.hash(), saved.hash()) << "step " << i;
  }
  for (int b = 0; b < saved.bodies(); ++b)
    EXPECT_TRUE(std::ranges::equal(saved.surface(b).position, restored.surface(b).position)) << "body " << b;
}

TEST_P(EveryKindOfTissue, ShowsThePressedSurfaceAtOnceAfterAStateIsRestored) {
  const PlayedScene played = GetParam().make();
  Simulator saved(played.scene, played.archives), restored(played.scene, played.archives);
  saved.start(played.inputs(0));
  play(saved, played, 0, GetParam().steps / 2);
  restored.restore(saved.save());
  for (int b = 0; b < saved.bodies(); ++b)
    EXPECT_TRUE(std::ranges::equal(saved.surface(b).position, restored.surface(b).position)) << "body " << b;
}

INSTANTIATE_TEST_SUITE_P(Simulator, EveryKindOfTissue,
                         ::testing::Values(Case{"quasi_static", testing::pressed_block, 400},
                                           Case{"relaxing", testing::relaxing_block, 400},
                                           Case{"tensor_mass", [] { return testing::cut_block<>(); }, 400},
                                           Case{"hybrid", [] { return testing::cut_block<HybridSpec>(); }, 400},
                                           Case{"catheter", testing::fed_catheter, 700}),
                         [](const auto& info) { return info.param.name; });

TEST(Simulator, AStateOfAnotherSceneIsRefused) {
  const PlayedScene block = testing::pressed_block(), tissue = testing::cut_block<>();
  Simulator one(block.scene, block.archives), other(tissue.scene, tissue.archives);
  one.start(block.inputs(0));
  const auto state = one.save();
  EXPECT_THROW(other.restore(state), std::runtime_error);
  Simulator begun(block.scene, block.archives);
  begun.start(block.inputs(0));
  begun.step(block.inputs(0));
  EXPECT_THROW(begun.restore(state), std::runtime_error);
}

TEST(Simulator, OneBitOfOneInputChangesTheHash) {
  const PlayedScene played = testing::pressed_block();
  Simulator one(played.scene, played.archives), other(played.scene, played.archives);
  for (Simulator* s : {&one, &other}) s->start(played.inputs(0));
  auto changed = played.inputs(0);
  changed[0].dofs.depth = std::nextafter(changed[0].dofs.depth, 1);
  one.step(played.inputs(0));
  other.step(changed);
  EXPECT_NE(one.hash(), other.hash());
}

TEST(Simulator, OfAQuasiStaticSceneItGivesWhatTheHapticStepGives) {
  const PlayedScene played = testing::pressed_block();
  Simulator simulator(played.scene, played.archives);
  HapticStep haptic(played.scene, played.archives);
  const auto dofs = [&](int i) { return std::array{played.inputs(i)[0].dofs}; };
  simulator.start(played.inputs(0));
  haptic.start(dofs(0));
  int touching = 0;
  for (int i = 0; i < 900; ++i) {
    simulator.step(played.inputs(i));
    haptic.step(dofs(i));
    const ToolView tool = simulator.tool(0);
    ASSERT_EQ(tool.force, haptic.force(0)) << "step " << i;
    ASSERT_EQ(tool.torque, haptic.torque(0)) << "step " << i;
    ASSERT_EQ(tool.flags, haptic.flags(0)) << "step " << i;
    ASSERT_EQ(simulator.energy(), haptic.energy()) << "step " << i;
    touching += !tool.force.isZero(0);
  }
  EXPECT_GT(touching, 200);
}

TEST(Simulator, APressedSurfaceGivesWayUnderTheTipAndComesBack) {
  const PlayedScene played = testing::pressed_block();
  Simulator simulator(played.scene, played.archives);
  const auto lowest_top = [&] {
    double lowest = 0;
    const auto& rest = played.archives[0].surface.position;
    const SurfaceView surface = simulator.surface(0);
    for (std::size_t n = 0; n < rest.size(); ++n)
      if (rest[n].z() > -1e-9) lowest = std::min(lowest, double(surface.position[n].z()));
    return lowest;
  };
  simulator.start(played.inputs(0));
  EXPECT_NEAR(lowest_top(), 0, 1e-9);
  play(simulator, played, 0, 157);  // deepest: 4 mm
  EXPECT_LT(lowest_top(), -0.002);
  EXPECT_FALSE(simulator.contacts(0).contacts.empty());
  play(simulator, played, 157, 400);
  EXPECT_NEAR(lowest_top(), 0, 1e-9);
}

TEST(Simulator, MovingTissuePushesTheToolBackAndLosesWhatIsCut) {
  const PlayedScene played = testing::cut_block<>();
  Simulator simulator(played.scene, played.archives);
  simulator.start(played.inputs(0));
  double pushed = 0;
  std::size_t removed = 0;
  for (int i = 0; i < 400; ++i) {
    simulator.step(played.inputs(i));
    const ToolView tool = simulator.tool(0);
    ASSERT_TRUE(tool.force.allFinite() && tool.torque.allFinite()) << "step " << i;
    if (i < 200) pushed = std::max(pushed, tool.force.z());
    for (const ChangeView& change : simulator.changes()) {
      EXPECT_EQ(change.body, 0);
      EXPECT_EQ(change.cause, cut);
      removed += change.removed.size();
    }
  }
  EXPECT_GT(pushed, 0.01);
  EXPECT_GT(removed, 0u);
  EXPECT_EQ(removed, simulator.tissue().organ(0).removed().size());
}

TEST(Simulator, ACatheterIsLedInAndTheTaskIsKept) {
  const PlayedScene played = testing::fed_catheter();
  Simulator simulator(played.scene, played.archives);
  simulator.start(played.inputs(0));
  play(simulator, played, 0, 600);
  EXPECT_EQ(simulator.tasks()[0].grasps, 1u);
  EXPECT_GT(simulator.tasks()[0].inserted, 0.008);
  EXPECT_GT(simulator.tool(0).grip_torque, 0);
}

/// A device whose handle is a mass on no spring: all that moves it is what the simulator gives it.
struct FreeHandle {
  double height;  ///< [m] of the tip above the tissue
  double grip;    ///< [rad]
  double speed = 0, grip_speed = 0;

  void receive(const ToolView& tool, double dt) {
    constexpr double mass = 0.2, inertia = 1e-3;  // [kg], [kg m^2]
    speed += tool.force.z() / mass * dt;
    height += speed * dt;
    grip_speed += tool.grip_torque / inertia * dt;
    grip += grip_speed * dt;
  }
};

TEST(Simulator, AFreeDevicePressedIntoAnOrganIsPushedOut) {
  for (const PlayedScene& played : {testing::pressed_block(), testing::cut_block<>()}) {
    Simulator simulator(played.scene, played.archives);
    const Tool& tool = played.scene.tools[0];
    const double top = played.scene.tools[0].pivot.z() > 0.25 ? 0.03 : 0;
    const auto at = [&](double height) {
      return std::array{ToolInput{tip_at(tool, {0, 0, top + std::get<ProbeSpec>(tool.end).radius + height})}};
    };
    FreeHandle handle{.height = 0.001, .grip = 0};
    simulator.start(at(handle.height));
    for (int i = 0; i < 200; ++i) simulator.step(at(handle.height -= 2e-5));  // the hand presses it down by 3 mm
    ASSERT_LT(handle.height, -0.0029) << played.name;
    for (int i = 0; i < 400; ++i) {
      handle.receive(simulator.tool(0), simulator.dt());
      simulator.step(at(handle.height));
    }
    EXPECT_GT(handle.height, 0) << played.name;
    EXPECT_TRUE(simulator.tool(0).force.isZero(0)) << played.name;
  }
}

TEST(Simulator, AFreeHandleOfAForcepsIsOpenedByWhatItHolds) {
  const PlayedScene played = testing::fed_catheter();
  Simulator simulator(played.scene, played.archives);
  simulator.start(played.inputs(0));
  play(simulator, played, 0, 250);
  auto input = played.inputs(250);
  FreeHandle handle{.height = 0, .grip = input[0].dofs.grip};
  const double closed = handle.grip;
  for (int i = 0; i < 20; ++i) {
    handle.receive(simulator.tool(0), simulator.dt());
    input[0].dofs.grip = std::min(handle.grip, 0.8);
    simulator.step(input);
  }
  EXPECT_GT(handle.grip, closed + 0.01);
}

}  // namespace
}  // namespace palpate::sim
