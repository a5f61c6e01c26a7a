#include "tools/rig/press_rig.hpp"

#include <gtest/gtest.h>

#include "tools/rig/example_bodies.hpp"
#include "tools/rig/kinds.hpp"
#include "tools/rig/scripted_tools.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

TEST(PressRig, TissuePressedAloneMovesAsItDoesInTheWholeScene) {
  HybridSpec split;
  split.hybrid.regions.push_back({{.indices = {}, .box = Box{{-1, -1, -1}, {0.001, 1, 1}}, .group = {}}});
  for (const Scene& scene : {moving_block_scene<TensorMassSpec>(), moving_block_scene(split)}) {
    PressRig alone(scene, {precompute_on(scene.bodies[0], small_block_mesh())}), whole(scene, alone.archives());
    const auto tip = [](int i) { return Vector3d(2e-5 * i, 0, 0.027 - 2e-5 * i); };
    whole.start(tip(0));
    for (int i = 0; i < 250; ++i) {
      alone.press(tip(i));
      whole.step(tip(i));
      ASSERT_EQ(alone.tissue().hash(), whole.tissue().hash()) << "tick " << i;
    }
    EXPECT_LT(alone.force().z(), -0.01);
    EXPECT_EQ(alone.force(), whole.force());
    EXPECT_EQ(alone.displacement(), whole.displacement());
  }
}

TEST(PressRig, TheHapticStepAloneGivesTheForceAndTheShapeOfTheWhole) {
  Scene scene = block_scene();
  scene.passivity.controller = false;
  scene.contact.rule = ContactRule::barycentric;
  PressRig alone(scene, {precompute_on(scene.bodies[0], block_mesh())}), whole(scene, alone.archives());
  const auto tip = [](int i) { return Vector3d(1e-5 * i, 0, 0.009 - 2e-5 * i); };
  for (PressRig* rig : {&alone, &whole}) rig->start(tip(0));
  for (int i = 0; i < 250; ++i) {
    alone.press(tip(i));
    whole.step(tip(i));
    ASSERT_EQ(alone.force(), whole.force()) << "tick " << i;
  }
  EXPECT_LT(alone.force().z(), -0.01);
  EXPECT_GT(held_points(alone.haptic(), 0), 0);
  EXPECT_EQ(held_points(alone.haptic(), 0, 0), held_points(alone.haptic(), 0));
  EXPECT_EQ(held_points(alone.haptic(), 0, 1), 0);
  const auto u = whole.displacement();
  EXPECT_EQ(alone.displacement(), u);
  const SurfaceMap& rest = whole.archives()[0].surface;
  const sim::SurfaceView shown = whole.simulator().surface(0);
  for (int n = 0; n < rest.size(); ++n)
    EXPECT_LT((rest.position[n] + u[n] - shown.position[n].cast<double>()).norm(), 1e-8);
}

TEST(PressRig, AskingForTheShapeChangesNothing) {
  const Scene scene = block_scene();
  PressRig asked(scene, {precompute_on(scene.bodies[0], block_mesh())}), other(scene, asked.archives());
  for (int i = 0; i < 100; ++i) {
    const Vector3d tip(0, 0, 0.009 - 3e-5 * i);
    for (PressRig* rig : {&asked, &other}) i == 0 ? rig->start(tip) : rig->step(tip);
    asked.displacement();
    ASSERT_EQ(asked.simulator().hash(), other.simulator().hash());
  }
}

TEST(ScriptedTools, RefuseAToolThatIsNotScripted) {
  Scene scene = block_scene();
  scene.tools[0].device = BusDeviceSpec{};
  EXPECT_THROW(ScriptedTools{scene}, std::runtime_error);
}

}  // namespace
}  // namespace palpate
