#include "render_node/scene_stage.hpp"

#include "common/mesh/mesh_file.hpp"
#include "common/view/view_origin.hpp"
#include "render_node/renderer.hpp"

namespace palpate {

Stage make_stage(const LoadedScene& loaded) {
  std::vector<SurfaceMap> surfaces;
  for (const Archive& archive : loaded.archives) surfaces.push_back(archive.surface);
  TriangleMesh backdrop;
  const auto& render = loaded.scene.render;
  if (render && !render->backdrop.empty()) backdrop = load_triangle_mesh(render->backdrop, render->backdrop_scale);
  const Eigen::Vector3d origin = view_origin(loaded.archives);
  if (!render || render->colour != Colouring::parts)
    return Stage(loaded.scene, surfaces, backdrop, load_visuals(loaded.scene, loaded.archives, origin), origin);
  Stage stage(loaded.scene, surfaces, backdrop, {}, origin);
  for (std::size_t b = 0; b < surfaces.size(); ++b)
    stage.colour_parts(static_cast<int>(b), loaded.archives[b].tetrahedra);
  return stage;
}

void write_still(const Stage& stage, int width, int height, const std::filesystem::path& file) {
  Renderer renderer(width, height, 4);  // a still has time for smooth edges
  Image image;
  renderer.draw(stage.frame(), image);
  write_png(image, file);
}

}  // namespace palpate
