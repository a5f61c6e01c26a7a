// What is drawn of a scene far from the world's origin is what is drawn of it there, to a micrometre.
#include <gtest/gtest.h>

#include "common/bus/memory_bus.hpp"
#include "common/mesh/near_origin.hpp"
#include "common/node/surface_source.hpp"
#include "render_node/stage.hpp"
#include "tests/render/ball_world.hpp"

namespace palpate {
namespace {

using namespace testing;
using Eigen::Vector3d;

constexpr double kClose = 1.5e-6;  // [m]

const Vector3d kFar(1e5, 5e4, -25'007);

Vector3d origin_of(const BallWorld& world) {
  return near_origin(world.archive.surface.position);
}

TEST(FarSurfaces, AreReceivedWhereTheyAreWhateverTheyAreCountedFrom) {
  for (const Vector3d& beside : {Vector3d(0, 0, 0), Vector3d(16, 0, -16)}) {
    BallWorld world(kFar);
    const auto writer = world.haptic_bus->writer(topics::surface_state);
    const auto source =
        receive_surfaces(*world.bus, world.presence, {world.archive.surface.position.size()}, origin_of(world));
    SurfaceState surface{.run = 5, .seq = 1, .step = 1, .sense_ns = 1};
    const Vector3d from = origin_of(world) + beside;
    surface.origin = {from.x(), from.y(), from.z()};
    for (const Vector3d& p : world.archive.surface.position)
      for (int axis = 0; axis < 3; ++axis) {
        surface.position.push_back(static_cast<float>(p[axis] - from[axis]));
        surface.normal.push_back(axis == 2 ? 1.0f : 0.0f);
      }
    writer->write(surface);
    ASSERT_TRUE(source->update());
    const SurfaceSource::Shape shape = source->shape(0);
    for (std::size_t n = 0; n < shape.position.size(); ++n)
      EXPECT_LT((origin_of(world) + shape.position[n].cast<double>() - world.archive.surface.position[n]).norm(),
                kClose);
  }
}

TEST(FarSurfaces, OfThisProcessAreWhereTheyAre) {
  BallWorld world(kFar);
  const auto writer = world.haptic_bus->writer(topics::contact_state);
  const auto source = deform_surfaces(world.scene, *world.bus, world.presence, Deformer(world.scene, {world.archive}),
                                      origin_of(world));
  ContactState contacts{.run = 5, .step = 1, .sense_ns = 1, .press = {0, 1, 0}};
  contacts.forces.push_back({0, 20, {0, 4, 0}});
  writer->write(contacts);
  ASSERT_TRUE(source->update());
  const Vector3d shown = origin_of(world) + source->shape(0).position[20].cast<double>();
  EXPECT_LT((shown - world.archive.surface.position[20] - Vector3d(0, 0.004, 0)).norm(), kClose);
}

TEST(FarStage, ShowsTheSamePicture) {
  const BallWorld near, far(kFar);
  const auto frame_of = [](Stage& stage) {
    ToolState tool;
    tool.depth = 0.15;
    stage.set_tool(tool);
    return stage.frame();
  };
  Stage here(near.scene, std::span(&near.archive.surface, 1), {}),
      there(far.scene, std::span(&far.archive.surface, 1), {}, {}, origin_of(far));
  const Frame a = frame_of(here), b = frame_of(there);
  const Vector3d apart = kFar - origin_of(far);
  EXPECT_LT((a.camera.eye + apart - b.camera.eye).norm(), 1e-9);
  EXPECT_LT((a.camera.target + apart - b.camera.target).norm(), 1e-9);
  ASSERT_EQ(b.instruments.size(), 1u);
  EXPECT_LT((a.instruments[0].tip.translation() + apart - b.instruments[0].tip.translation()).norm(), 1e-9);
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  ASSERT_EQ(a.meshes[0].position.size(), b.meshes[0].position.size());
  for (std::size_t v = 0; v < a.meshes[0].position.size(); ++v)
    EXPECT_LT((a.meshes[0].position[v].cast<double>() + apart - b.meshes[0].position[v].cast<double>()).norm(), kClose);
}

}  // namespace
}  // namespace palpate
