#include "common/view/visual_body.hpp"

#include <algorithm>
#include <set>

#include "common/files/png_file.hpp"
#include "common/mesh/near_origin.hpp"
#include "common/mesh/visual_shape.hpp"

namespace palpate {
namespace {

std::array<int, 3> sorted(std::array<int, 3> t) {
  std::ranges::sort(t);
  return t;
}

/// It lies about the mesh, from which loads have moved the body. `rest`: where they have its nodes.
void follow_loads(VisualMesh& visual, const Archive& archive, const std::vector<Eigen::Vector3d>& rest) {
  std::vector<Eigen::Vector3d> of_mesh = rest;
  for (std::size_t n = 0; n < rest.size(); ++n) of_mesh[n] -= archive.sag[n];
  std::vector<Eigen::Vector3f> nodes;
  for (const Eigen::Vector3d& x : rest) nodes.push_back(x.cast<float>());
  VisualShape shape(visual, bind_visual(visual.position, of_mesh, archive.surface.triangles, archive.tetrahedra),
                    of_mesh);
  shape.place(nodes);
  visual.position = shape.position();
}

}  // namespace

std::optional<VisualBody> load_visual(const Body& body, const Archive& archive, const Eigen::Vector3d& origin) {
  const VisualSpec* spec = visual_of(body);
  if (!spec) return {};
  VisualBody visual{load_visual_mesh(*spec, origin), {}, {}};
  const std::vector<Eigen::Vector3d> rest = counted_from(origin, archive.surface.position);
  if (!archive.sag.empty()) follow_loads(visual.mesh, archive, rest);
  visual.binding = bind_visual(visual.mesh.position, rest, archive.surface.triangles, archive.tetrahedra);
  if (!spec->texture.empty()) visual.texture = read_png_bytes(spec->texture, kMaxTextureSide);
  return visual;
}

std::vector<std::optional<VisualBody>> load_visuals(const Scene& scene, std::span<const Archive> archives,
                                                    const Eigen::Vector3d& origin) {
  std::vector<std::optional<VisualBody>> visuals;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    visuals.push_back(load_visual(scene.bodies[b], archives[b], origin));
  return visuals;
}

PartLook look_of(const VisualMesh::Part& part, const std::array<double, 3>& tissue) {
  if (part.colour) return {Finish::membrane, *part.colour};
  return {Finish::tissue, tissue};
}

std::vector<std::array<int, 3>> bared(std::span<const std::array<int, 3>> whole,
                                      std::span<const std::array<int, 3>> now) {
  std::set<std::array<int, 3>> before;
  for (const auto& t : whole) before.insert(sorted(t));
  std::vector<std::array<int, 3>> seen;
  std::set<int> nodes;
  for (const auto& t : now) {
    if (before.contains(sorted(t))) continue;
    seen.push_back(t);
    nodes.insert(t.begin(), t.end());
  }
  const auto is_near = [&](int n) { return nodes.contains(n); };
  for (const auto& t : now)
    if (before.contains(sorted(t)) && std::ranges::any_of(t, is_near)) seen.push_back(t);
  return seen;
}

}  // namespace palpate
