#include "tools/film/path_picture.hpp"

#include "common/mesh/near_origin.hpp"
#include "common/node/node_setup.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/view/view_origin.hpp"
#include "render_node/renderer.hpp"
#include "render_node/scene_stage.hpp"
#include "tools/film/path_shape.hpp"
#include "tools/motion/choose_tool.hpp"
#include "tools/motion/tip_path.hpp"

namespace palpate {
namespace {

constexpr float kTube = 0.0008f, kBall = 0.0022f;  // [m] radii
constexpr int kFirstId = 1 << 20;                  // of meshes: beyond those of a stage

MeshView view_of(const PathShape& shape, int id, const std::array<double, 3>& colour) {
  return {.id = id,
          .finish = Finish::membrane,
          .colour = colour,
          .rest = shape.position,
          .position = shape.position,
          .normal = shape.normal,
          .triangles = shape.triangles};
}

ToolState state_of(int tool, const ToolDofs& dofs) {
  return {.tool = static_cast<std::uint32_t>(tool),
          .yaw = dofs.yaw,
          .pitch = dofs.pitch,
          .depth = dofs.depth,
          .roll = dofs.roll,
          .grip = dofs.grip,
          .opening = dofs.grip};
}

}  // namespace

void draw_path(const PathPictureSettings& s) {
  const Scene scene = load_scene(s.scene);
  const int number = choose_tool(scene, s.tool);
  const Tool& tool = scene.tools[number];
  const Trajectory motion = load_trajectory(s.trajectory);
  for (const Body& body : scene.bodies) ensure_archive(scene, body);
  const LoadedScene loaded = with_archives(scene, ArchivePart::surface, ArchivePart::header);

  Stage stage = make_stage(loaded);
  stage.set_tool(state_of(number, motion.at(motion.duration())));
  const TipPath path = tip_path(make_trocar(tool.pivot, tool.axis, tool.up), reach_of(tool), motion);
  const Eigen::Vector3d origin = view_origin(loaded.archives);
  const PathShape tube = tube_along(places_from(origin, path.points), kTube);
  const PathShape balls = balls_at(places_from(origin, path.stands), kBall);
  Frame frame = stage.frame();
  frame.meshes.push_back(view_of(tube, kFirstId, {0.9, 0.7, 0.05}));
  frame.meshes.push_back(view_of(balls, kFirstId + 1, {0.05, 0.35, 0.9}));
  const Render picture = scene.render.value_or(Render{});
  Renderer renderer(picture.width, picture.height, 4);
  Image image;
  renderer.draw(frame, image);
  write_png(image, s.picture);
}

}  // namespace palpate
