#include <gtest/gtest.h>

#include "common/bus/memory_bus.hpp"
#include "common/realtime/clock.hpp"
#include "common/view/backdrop.hpp"
#include "render_node/render_loop.hpp"
#include "tests/render/ball_world.hpp"

namespace palpate {
namespace {

using namespace testing;

TEST(SurfaceSource, DeformsReceivedContacts) {
  BallWorld world;
  const auto writer = world.haptic_bus->writer(topics::contact_state);
  const auto source = deform_surfaces(world.scene, *world.bus, world.presence, Deformer(world.scene, {world.archive}));
  EXPECT_FALSE(source->update());
  writer->write(world.press(20, 4));
  EXPECT_TRUE(source->update());
  const auto rest = world.archive.surface.position[20].cast<float>();
  EXPECT_NEAR(source->shape(0).position[20].y() - rest.y(), 0.004, 1e-6);
  EXPECT_EQ(source->refused(), 0u);
}

TEST(SurfaceSource, KeepsTheContactsOfADeadHapticNode) {
  BallWorld world;
  auto writer = world.haptic_bus->writer(topics::contact_state);
  const auto held = world.haptic_bus->reader(topics::held_contacts);
  const auto source = deform_surfaces(world.scene, *world.bus, world.presence, Deformer(world.scene, {world.archive}));
  ContactState contacts = world.press(20, 4);
  contacts.contacts.resize(1);
  contacts.contacts[0].normal = {0, 1, 0};
  writer->write(contacts);
  source->update();
  source->watch(now_ns());
  EXPECT_FALSE(held->take());
  writer.reset();
  source->update();
  source->watch(now_ns());
  const auto kept = held->take();
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->run, 5u);
  EXPECT_EQ(kept->contacts.size(), 1u);
}

TEST(SurfaceSource, RefusesForeignRunsAndSurfacesThatDoNotFit) {
  BallWorld world;
  const auto writer = world.haptic_bus->writer(topics::surface_state);
  const auto source = receive_surfaces(*world.bus, world.presence, world.nodes());
  SurfaceState surface;
  surface.sense_ns = now_ns();
  surface.run = 6;
  surface.position.assign(3 * world.nodes()[0], 0.01f);
  surface.normal.assign(3 * world.nodes()[0], 0.5f);
  writer->write(surface);
  EXPECT_FALSE(source->update());
  surface.run = 5;
  surface.position.resize(6);
  surface.normal.resize(6);
  writer->write(surface);
  EXPECT_FALSE(source->update());
  EXPECT_EQ(source->refused(), 2u);
  EXPECT_TRUE(source->shape(0).position.empty());
  surface.position.assign(3 * world.nodes()[0], 0.01f);
  surface.normal.assign(3 * world.nodes()[0], 0.5f);
  writer->write(surface);
  EXPECT_TRUE(source->update());
  EXPECT_EQ(source->shape(0).position.size(), world.nodes()[0]);
}

TEST(Stage, ShowsToolsOnceHeardOf) {
  BallWorld world;
  Stage stage = world.stage();
  EXPECT_TRUE(stage.frame().instruments.empty());
  ToolState tool;
  tool.depth = 0.15;
  EXPECT_TRUE(stage.set_tool(tool));
  const Frame frame = stage.frame();
  ASSERT_EQ(frame.instruments.size(), 1u);
  EXPECT_TRUE(frame.instruments[0].tip.translation().isApprox(Eigen::Vector3d(0, 0, 0.05)));
  tool.tool = 1;
  EXPECT_FALSE(stage.set_tool(tool));
}

TEST(Stage, OpensOnlyJawsThatThereAre) {
  BallWorld world;
  ToolState tool;
  tool.grip = 0.3;
  for (const bool jaws : {false, true}) {
    if (jaws) std::get<ProbeSpec>(world.scene.tools[0].end).jaws.emplace();
    Stage stage = world.stage();
    stage.set_tool(tool);
    EXPECT_DOUBLE_EQ(stage.frame().instruments.at(0).jaw_opening, jaws ? 0.3 : 0);
  }
}

TEST(Stage, LegendCoversTheLargestDisplacement) {
  BallWorld world;
  world.scene.render->colour = Colouring::displacement;
  Stage stage = world.stage();
  EXPECT_DOUBLE_EQ(stage.frame().legend->max, 1e-3);
  std::vector<Eigen::Vector3f> position, normal(world.nodes()[0], Eigen::Vector3f::UnitX());
  for (const auto& p : world.archive.surface.position) position.push_back(p.cast<float>());
  position[10].x() += 0.0073f;
  stage.set_surface(0, position, normal);
  EXPECT_NEAR(stage.frame().legend->max, 0.008, 1e-12);
  EXPECT_NEAR(stage.frame().meshes[0].scalar[10], 0.0073, 1e-6);
}

TEST(Stage, SceneWithoutCameraSeesAllBodies) {
  BallWorld world;
  world.scene.render.reset();
  const Stage stage = world.stage();
  Frame nothing;
  nothing.camera = stage.frame().camera;
  EXPECT_GT(difference(picture(stage.frame()), picture(nothing)), 0.05);
}

TEST(Backdrop, OpenSheetsAreLiningAndClosedPartsAreBone) {
  TriangleMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const std::size_t closed = mesh.triangles.size();
  const int first = static_cast<int>(mesh.nodes.size());
  for (const double x : {0.0, 1.0}) mesh.nodes.insert(mesh.nodes.end(), {{x, 0, 0}, {x, 1, 0}});
  mesh.triangles.insert(mesh.triangles.end(), {{first, first + 2, first + 3}, {first, first + 3, first + 1}});
  const Backdrop sorted = sort_backdrop(mesh);
  EXPECT_EQ(sorted.bones.triangles.size(), closed);
  ASSERT_EQ(sorted.lining.triangles.size(), 2u);
  EXPECT_EQ(sorted.lining.triangles[0][0], first);
}

TEST(Backdrop, AClosedPartThatFacesInwardIsLining) {
  TriangleMesh mesh;
  mesh.nodes = {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {5, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  const Backdrop sorted = sort_backdrop(mesh);
  EXPECT_TRUE(sorted.bones.triangles.empty());
  EXPECT_EQ(sorted.lining.triangles.size(), mesh.triangles.size());
}

/// A second of a ball that is pressed, drawn and filmed.
struct Filmed {
  RenderReport report;
  long pictures;  ///< of the film
  Frame best;
};

Filmed film_a_press() {
  BallWorld world;
  const Folder folder;
  const auto tools = world.haptic_bus->writer(topics::tool_state);
  const auto forces = world.haptic_bus->writer(topics::force_state);
  const auto contacts = world.haptic_bus->writer(topics::contact_state);
  const auto source = deform_surfaces(world.scene, *world.bus, world.presence, Deformer(world.scene, {world.archive}));
  Renderer renderer(160, 120);
  Film film(folder.path / "a.mp4", 160, 120, 25);
  RenderLoop loop(world.scene, world.stage(), *source, *world.bus, world.presence, renderer);
  loop.set_film(&film);
  ToolState tool;
  tool.run = 5;
  tool.depth = 0.15;
  tools->write(tool);
  ForceState force;
  force.run = 5;
  force.force = {0, -3, 4};
  forces->write(force);
  contacts->write(world.press(20, 4));
  const RenderReport report = loop.run(1.0);
  film.finish();
  return {report, film.frames(), loop.best_moment().frame()};
}

TEST(RenderLoop, DrawsAtTheVisualRateAndFilmsInRealTime) {
  Filmed filmed = film_a_press();
  // Where the machine stood, at the end above all, the run is longer than asked for, and than its film.
  for (int again = 0; again < 2 && filmed.report.missed > 2; ++again) filmed = film_a_press();
  const auto& [report, pictures, best] = filmed;
  EXPECT_NEAR(report.seconds, 1, 0.1);
  EXPECT_GE(report.frames + report.missed, 45u);
  EXPECT_LE(report.frames, 52u);
  // Pictures that the encoder has no time for at the end are not in it.
  const double due = 25 * report.seconds, shown = static_cast<double>(pictures);
  EXPECT_LE(shown, due + 2);
  EXPECT_GE(shown + static_cast<double>(report.film.skipped), due - 2);
  EXPECT_EQ(report.latency.count(), 1u);
  EXPECT_DOUBLE_EQ(report.peak_force, 5);
  EXPECT_EQ(report.refused, 0u);
  EXPECT_EQ(best.instruments.size(), 1u);
  ASSERT_TRUE(best.overlay);
  EXPECT_EQ(best.overlay->lines.front(), "a ball");
  EXPECT_EQ(best.overlay->lines.back(), "probe  5.00 N");
}

}  // namespace
}  // namespace palpate
