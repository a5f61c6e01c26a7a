#include "common/models/check/visual_check.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "common/files/png_file.hpp"
#include "common/mesh/visual_binding.hpp"
#include "common/mesh/visual_mesh.hpp"

namespace palpate {
namespace {

/// [m] diagonal of the box about points.
template <class Points>
double extent(const Points& points) {
  Eigen::AlignedBox3d box;
  for (const auto& p : points) box.extend(p.template cast<double>());
  return box.diagonal().norm();
}

struct Outside {
  std::size_t vertices = 0;
  double farthest = 0;  ///< [m]
};

Outside outside_of(const TetMesh& mesh, const VisualMesh& visual) {
  Outside outside;
  for (const VisualBinding::Tie& tie : bind_visual(visual.position, mesh.nodes, {}, mesh.tetrahedra).ties) {
    outside.vertices += tie.distance > 0;
    outside.farthest = std::max(outside.farthest, static_cast<double>(tie.distance));
  }
  return outside;
}

}  // namespace

void check_visual(const SolidSpec& body, const TetMesh& mesh, CheckReport& report) {
  if (!body.visual) return;
  const VisualMesh visual = load_visual_mesh(*body.visual);
  const Outside outside = outside_of(mesh, visual);
  report.say(fmt::format("  visual: {} triangles, {} vertices, {} parts by their materials", visual.triangles(),
                         visual.position.size(), visual.parts.size()));
  report.say(fmt::format("  visual: {} vertices lie outside of the mesh, the farthest {:.1f} mm", outside.vertices,
                         1e3 * outside.farthest));
  if (!body.visual->texture.empty()) {
    const PngSize size = png_size(read_png_bytes(body.visual->texture, kMaxTextureSide), body.visual->texture);
    report.say(fmt::format("  texture: {} x {} pixels", size.width, size.height));
  }
  const double own = extent(mesh.nodes), seen = extent(visual.position);
  if (seen > 2 * own || own > 2 * seen)
    report.warnings.push_back(fmt::format(
        "body '{}' is {:.3g} m across and its visual surface {:.3g} m: is its 'scale' right?", body.name, own, seen));
  else if (outside.farthest > 0.5 * own)
    report.warnings.push_back(
        fmt::format("body '{}': its visual surface goes {:.0f} mm away from the mesh: does it lie "
                    "where the body lies?",
                    body.name, 1e3 * outside.farthest));
  if (visual.triangles() > kFluentTriangles)
    report.warnings.push_back(
        fmt::format("body '{}': {} triangles are more than the {} that 60 pictures a second have "
                    "time for",
                    body.name, visual.triangles(), kFluentTriangles));
}

}  // namespace palpate
