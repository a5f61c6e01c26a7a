#include <gtest/gtest.h>

#include "common/bus/memory_bus.hpp"
#include "common/realtime/clock.hpp"
#include "render_node/render_loop.hpp"
#include "tests/models/duct_scene.hpp"
#include "tests/render/scenery.hpp"

namespace palpate {
namespace {

using namespace testing;

/// The duct and the catheter alone, seen from the side or into the mouth where the catheter comes in.
struct DuctStage {
  DuctScene s;
  DuctStage() {
    s.scene.bodies[kOrganBody] = Body{};
    s.scene.render = Render{.width = 320, .height = 240};
    s.scene.render->overlay = false;
    look_from({0.02, -0.07, 0.025}, {0, 0, 0.025});
    s.scene.tools.resize(1);
    Tool& tool = s.scene.tools[0];
    tool.name = "forceps";
    tool.end = ForcepsSpec{};
    tool.pivot = {0.1, -0.02, 0.01};
    tool.axis = {-1, 0, 0};
    tool.up = {0, 0, 1};
  }
  void look_from(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
    s.scene.render->camera = {.eye = eye, .target = target, .up = {1, 0, 0}, .field_of_view = 50};
  }
  Stage stage() const {
    std::vector<SurfaceMap> surfaces;
    for (const Archive& archive : s.archives) surfaces.push_back(archive.surface);
    surfaces[kOrganBody] = {};
    return Stage(s.scene, surfaces, {});
  }
};

const MeshView& mesh_of(const Frame& frame, Finish finish) {
  return *std::ranges::find(frame.meshes, finish, &MeshView::finish);
}

Frame only(Frame frame, std::initializer_list<Finish> finishes) {
  std::erase_if(frame.meshes,
                [&](const MeshView& m) { return std::ranges::find(finishes, m.finish) == finishes.end(); });
  return frame;
}

TEST(DuctStage, ADuctHasTwoSidesAndACatheterIsOneTube) {
  const DuctStage d;
  const Stage stage = d.stage();
  const Frame frame = stage.frame();
  const MeshView &outer = mesh_of(frame, Finish::duct), &inner = mesh_of(frame, Finish::mucosa),
                 &tube = mesh_of(frame, Finish::plastic);
  EXPECT_EQ(frame.meshes.size(), 4u);
  EXPECT_NE(outer.id, inner.id);
  const auto radius = [](const Eigen::Vector3f& p) { return p.head<2>().norm(); };
  for (const auto& p : outer.position) EXPECT_NEAR(radius(p), 0.005, 0.0002);
  float least = 1;
  for (const auto& p : inner.position) least = std::min(least, radius(p));
  EXPECT_NEAR(least, 0.004, 0.0002);
  EXPECT_EQ(tube.triangles.size(), d.s.archives[kCatheterBody].surface.triangles.size());
}

TEST(DuctStage, WallTubeAndTissueAreToldApartInThePicture) {
  const DuctStage d;
  const Stage stage = d.stage();
  const Frame frame = stage.frame();
  const Image background = picture(only(frame, {})), duct = picture(only(frame, {Finish::duct, Finish::mucosa})),
              tube = picture(only(frame, {Finish::plastic}));
  EXPECT_GT(difference(duct, background, 8), 0.03);
  EXPECT_GT(difference(tube, background, 8), 0.01);
  const auto red = [](const std::uint8_t* p) { return p[0] > 100 && p[0] > 1.25 * p[2]; };
  const auto pale = [](const std::uint8_t* p) { return p[2] > 100 && p[2] >= p[0]; };
  EXPECT_GT(share(duct, red), 0.02);
  EXPECT_LT(share(duct, pale), 0.001);
  EXPECT_GT(share(tube, pale), 0.008);
  EXPECT_EQ(share(background, pale), 0);
}

TEST(DuctStage, TheMouthShowsTheInnerSideAndNoHole) {
  DuctStage d;
  d.look_from({0, 0, 0.085}, {0, 0, 0.05});
  const Stage stage = d.stage();
  const Frame frame = stage.frame();
  const Image both = picture(only(frame, {Finish::duct, Finish::mucosa})), outer = picture(only(frame, {Finish::duct})),
              background = picture(only(frame, {}));
  // A disc of 5 mm, the rim, 35 mm away, less what is seen out of the far mouth.
  const auto area = [](double radius, double distance) {
    const double half = std::tan(25 * std::numbers::pi / 180);
    return std::numbers::pi * std::pow(radius / distance, 2) / (4 * half * half * 320 / 240);
  };
  const double expected = area(0.005, 0.035) - area(0.004, 0.085);
  EXPECT_NEAR(difference(both, background, 0), expected, 0.05 * expected);
  EXPECT_LT(difference(outer, background, 0), 0.1 * expected);  // whose outer side looks away
}

TEST(DuctStage, TheCatheterHasAMarkEveryTenMillimetres) {
  DuctStage d;
  d.look_from({0, -0.06, -0.01}, {0, 0, -0.01});
  const Stage stage = d.stage();
  const Image image = picture(only(stage.frame(), {Finish::plastic}), 320, 240, 4);
  // Camera up is x: the tube lies along z, level in the picture's middle.
  std::vector<double> along(320, 0.0);
  for (int x = 0; x < 320; ++x)
    for (int y = 112; y < 128; ++y) along[x] = std::max(along[x], brightness(image, x, y));
  int marks = 0;
  bool dark = false;
  for (int x = 12; x + 12 < 320; ++x) {
    const bool now = along[x] < 0.8 * std::min(along[x - 12], along[x + 12]);
    marks += now && !dark;
    dark = now;
  }
  const double shown = 2 * 0.06 * std::tan(25 * std::numbers::pi / 180) * 296 / 240;  // [m] across what was looked at
  EXPECT_NEAR(marks, shown / 0.010, 1.01);
}

TEST(DuctStage, FollowsShapesAndDrawsThem) {
  const DuctStage d;
  Stage stage = d.stage();
  const Image rest = picture(stage.frame());
  Deformer deformer(d.s.scene, d.s.archives);
  ASSERT_TRUE(deformer.take(d.s.catheter_state(-0.02, 3e-5)));
  deformer.deform();
  stage.set_surface(kCatheterBody, deformer.surface(kCatheterBody).position, deformer.surface(kCatheterBody).normal);
  const Image moved = picture(stage.frame());
  EXPECT_GT(difference(rest, moved, 8), 0.01);

  std::vector<Eigen::Vector3f> position = deformer.surface(kDuctBody).position;
  for (auto& p : position) p.x() += 0.004f;
  stage.set_surface(kDuctBody, position, deformer.surface(kDuctBody).normal);
  const Frame frame = stage.frame();
  EXPECT_GT(difference(moved, picture(frame), 8), 0.01);
  for (const auto& p : mesh_of(frame, Finish::duct).position)
    EXPECT_NEAR((p - Eigen::Vector3f(0.004f, 0, 0)).head<2>().norm(), 0.005, 0.0002);
}

TEST(DuctStage, ColourByDisplacementCoversBothSidesButNotTheCatheter) {
  DuctStage d;
  d.s.scene.render->colour = Colouring::displacement;
  Stage stage = d.stage();
  Deformer deformer(d.s.scene, d.s.archives);
  std::vector<Eigen::Vector3f> position = deformer.surface(kDuctBody).position;
  for (auto& p : position) p.x() += 0.002f;
  stage.set_surface(kDuctBody, position, deformer.surface(kDuctBody).normal);
  const Frame frame = stage.frame();
  for (const Finish side : {Finish::duct, Finish::mucosa}) {
    const MeshView& mesh = mesh_of(frame, side);
    ASSERT_EQ(mesh.scalar.size(), mesh.position.size());
    for (const float value : mesh.scalar) EXPECT_NEAR(value, 0.002, 1e-6);
  }
  EXPECT_TRUE(mesh_of(frame, Finish::plastic).scalar.empty());
  EXPECT_GT(difference(picture(frame), picture(only(frame, {})), 8), 0.03);
}

TEST(DuctStage, AForcepsOpensAsFarAsItsJawsReallyAre) {
  const DuctStage d;
  Stage stage = d.stage();
  ToolState tool;
  tool.depth = 0.1;
  tool.grip = 0;
  tool.opening = 0.5;
  ASSERT_TRUE(stage.set_tool(tool));
  const Frame frame = stage.frame();
  ASSERT_EQ(frame.instruments.size(), 1u);
  EXPECT_DOUBLE_EQ(frame.instruments[0].jaw_opening, 0.5);
  EXPECT_DOUBLE_EQ(frame.instruments[0].jaw_length, TurningJaws{}.length);
  Frame without = frame;
  without.instruments.clear();
  EXPECT_GT(difference(picture(frame), picture(without), 8), 0.01);
}

/// A haptic node with run 5 and a picture of its scene.
struct TaskWorld {
  std::shared_ptr<MemoryNetwork> network = make_memory_network();
  std::unique_ptr<Bus> haptic_bus = make_memory_bus(network), bus = make_memory_bus(network);
  Presence haptic{*haptic_bus, "haptic", 5, "scene", "archive"};
  Presence presence{*bus, "render", 0, "scene", "archive"};
  DuctStage d;
  std::unique_ptr<Writer<TaskRecord>> tasks = haptic_bus->writer(topics::task_record);
  std::unique_ptr<Writer<ForceState>> forces = haptic_bus->writer(topics::force_state);

  TaskWorld() {
    d.s.scene.render->overlay = true;
    d.s.scene.rates.visual_hz = 50;
    presence.watch();
  }
  std::vector<std::string> lines(const TaskRecord& task) {
    const auto source = deform_surfaces(d.s.scene, *bus, presence, Deformer(d.s.scene, d.s.archives));
    Renderer renderer(160, 120);
    RenderLoop loop(d.s.scene, d.stage(), *source, *bus, presence, renderer);
    EXPECT_EQ(tasks->readers(), 1);
    tasks->write(task);
    forces->write({.run = 5, .force = {0, 0.3, 0.4}, .grip = 0.014});
    loop.run(0.3);
    return loop.best_moment().frame().overlay->lines;
  }
};

TEST(DuctStage, TheOverlayTellsHowTheTaskGoes) {
  TaskWorld world;
  const TaskRecord task{.body = kCatheterBody,
                        .run = 5,
                        .inserted = 0.0221,
                        .deepest = 0.0243,
                        .inserting_s = 8.24,
                        .max_force = 0.612,
                        .wall_contacts = 5,
                        .grasps = 2,
                        .drops = 1};
  const std::vector<std::string> lines = world.lines(task);
  const auto has = [&](const std::string& line) { return std::ranges::find(lines, line) != lines.end(); };
  EXPECT_TRUE(has("inserted 22.1 mm, deepest 24.3 mm, reached in 8.2 s, held for 0.0 s"));
  EXPECT_TRUE(has("largest force 0.61 N, wall contacts 5, grasps 2, drops 1"));
  EXPECT_TRUE(has("forceps  0.50 N  grip 14 N mm"));
}

TEST(DuctStage, TaskRecordsOfOtherRunsAndBodiesAreNotShown) {
  for (const TaskRecord& task : {TaskRecord{.body = kCatheterBody, .run = 8}, TaskRecord{.body = kDuctBody, .run = 5},
                                 TaskRecord{.body = 7, .run = 5}}) {
    TaskWorld world;
    for (const std::string& line : world.lines(task)) EXPECT_EQ(line.find("inserted"), std::string::npos);
  }
}

TEST(DuctStage, ScenesWithoutACatheterAskForNoTaskRecord) {
  TaskWorld world;
  world.d.s.scene.bodies.resize(1);
  world.d.s.archives.resize(1);
  const auto source =
      deform_surfaces(world.d.s.scene, *world.bus, world.presence, Deformer(world.d.s.scene, world.d.s.archives));
  Renderer renderer(160, 120);
  std::vector<SurfaceMap> surfaces{world.d.s.archives[0].surface};
  const RenderLoop loop(world.d.s.scene, Stage(world.d.s.scene, surfaces, {}), *source, *world.bus, world.presence,
                        renderer);
  EXPECT_EQ(world.tasks->readers(), 0);
}

}  // namespace
}  // namespace palpate
