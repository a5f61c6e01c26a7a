#include "tools/visual_about.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>
#include <stdexcept>

#include "common/files/ending.hpp"
#include "common/files/png_file.hpp"
#include "common/mesh/obj_file.hpp"
#include "common/mesh/visual_mesh.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

fs::path beside(const fs::path& file, const std::string& ending) {
  return fs::path(file).replace_extension(ending);
}

/// The one image that materials wear; empty: they wear none.
fs::path image_of(const fs::path& materials) {
  std::set<std::string> names;
  for (const auto& [name, material] : load_mtl(materials))
    if (material.textured) names.insert(material.image);
  if (names.size() > 1)
    throw std::runtime_error(fmt::format("{}: its materials wear {} images, and a surface wears one in a scene",
                                         materials.string(), names.size()));
  return names.empty() ? fs::path() : fs::path(*names.begin());
}

fs::path texture_of(const fs::path& surface, const fs::path& materials) {
  const fs::path named = image_of(materials);
  if (named.empty()) return {};
  const fs::path folder = materials.parent_path();
  for (const fs::path& file :
       {folder / named, folder / named.filename(), beside(folder / named.filename(), ".png"), beside(surface, ".png")})
    if (has_ending(file, ".png") && fs::is_regular_file(file)) return file;
  throw std::runtime_error(fmt::format(
      "{}: its materials wear the image '{}', and no PNG of this name or of the surface's lies there: save it as {}",
      materials.string(), named.string(), beside(surface, ".png").filename().string()));
}

VisualSpec with_colours(const fs::path& surface) {
  VisualSpec visual{.surface = surface};
  if (!has_ending(surface, ".obj")) return visual;
  if (const fs::path materials = beside(surface, ".mtl"); fs::exists(materials)) {
    visual.materials = materials;
    visual.texture = texture_of(surface, materials);
  } else if (const fs::path image = beside(surface, ".png"); fs::exists(image)) {
    const VisualMesh wearing = load_obj(surface, 1, {}, true);
    if (std::ranges::any_of(wearing.parts, &VisualMesh::Part::textured)) visual.texture = image;
  }
  if (!visual.texture.empty()) read_png_bytes(visual.texture, kMaxTextureSide);
  return visual;
}

}  // namespace

VisualSpec visual_about(const TetMesh& mesh, const fs::path& surface) {
  VisualSpec visual = with_colours(surface);
  const VisualMesh seen = load_visual_mesh(visual);
  Eigen::AlignedBox3d tissue, picture;
  for (const Eigen::Vector3d& x : mesh.nodes) tissue.extend(x);
  for (const Eigen::Vector3f& x : seen.position) picture.extend(x.cast<double>());
  constexpr double kNear = 0.25;  // of the mesh's diagonal, by which corners of the boxes may lie apart
  const auto lies_about = [&](double scale) {
    const double apart =
        std::max((scale * picture.min() - tissue.min()).norm(), (scale * picture.max() - tissue.max()).norm());
    return apart < kNear * tissue.diagonal().norm();
  };
  if (!lies_about(visual.scale) && !lies_about(visual.scale = 1e-3))
    throw std::runtime_error(
        fmt::format("{}: it does not lie about the mesh, neither in metres nor in millimetres", surface.string()));
  return visual;
}

}  // namespace palpate
