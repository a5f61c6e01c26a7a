// Hybrid bodies: contrasts across the border, shares of dynamic tissue, tearing cascades.
#include <fmt/format.h>

#include <cmath>

#include "tools/rig/example_bodies.hpp"
#include "tools/stability/press.hpp"

namespace palpate::stability {
namespace {

/// The block with its upper part, from `share` of its height on, dynamic.
Scene hybrid_scene(const TetMesh& mesh, double share) {
  HybridSpec body;
  ElementSelector& upper = body.hybrid.regions.emplace_back();
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t) {
    double height = 0;
    for (const int n : mesh.tetrahedra[t]) height += mesh.nodes[n].z() / 4;
    if (height > share * 0.02) upper.indices.push_back(t);
  }
  return moving_block_scene(std::move(body));
}

std::vector<int>& upper_part(Scene& scene) {
  return std::get<HybridSpec>(scene.bodies[0]).hybrid.regions[0].indices;
}

void soften(Scene& scene, double young, double density) {
  Material upper = moving_block_of(scene).material;
  upper.young *= young;
  upper.density *= density;
  moving_block_of(scene).materials.push_back(
      {{.indices = {}, .box = Box{{-1, -1, 0.0095}, {1, 1, 1}}, .group = {}}, upper});
}

}  // namespace

std::vector<Point> hybrid_points(const Extent& extent) {
  std::vector<Point> points;
  const auto add = [&](const char* parameter, const std::string& value, auto&& change) {
    points.push_back({"hybrid", parameter, value,
                      [=] {
                        const TetMesh mesh = small_block_mesh();
                        Scene scene = hybrid_scene(mesh, 0.5);
                        change(scene);
                        return press_tissue(scene, mesh, 0.004, 300);
                      },
                      120});
  };
  for (double c : extent.quick ? std::vector{1e-4} : std::vector{1e-6, 1e-4, 1e-2, 1e2, 1e4})
    add("E dynamic / E quasi-static [1]", fmt::format("{:g}", c), [c](Scene& s) { soften(s, c, 1); });
  for (double c : extent.quick ? std::vector{1e3} : std::vector{1e-4, 1e-2, 1e2, 1e3})
    add("density dynamic / quasi-static [1]", fmt::format("{:g}", c), [c](Scene& s) { soften(s, 1, c); });
  for (double a : extent.quick ? std::vector{0.0} : std::vector{0.0, 1.0, 1e4})
    add("damping [1/s]", fmt::format("{:g}", a), [a](Scene& s) { moving_block_of(s).dynamic.damping = a; });
  for (double s : extent.quick ? std::vector{10.0} : std::vector{2.0, 10.0})
    add("step / what the bound gives about [1]", fmt::format("{:g}", s),
        [s](Scene& scene) { moving_block_of(scene).dynamic.step = s * 5e-4; });
  for (double t : extent.quick ? std::vector{0.02} : std::vector{1e-6, 0.02, 0.2})
    add("tears from a volume change of [1]", fmt::format("{:g}", t), [t](Scene& scene) {
      moving_block_of(scene).tearing = Tearing{.criterion = TearCriterion::volume, .threshold = t};
    });
  for (double share : extent.quick ? std::vector{0.7} : std::vector{-0.1, 0.2, 0.5, 0.7, 0.95})
    points.push_back({"hybrid share", "height of the border [1]", fmt::format("{:g}", share), [share] {
                        const TetMesh mesh = small_block_mesh();
                        Scene scene = hybrid_scene(mesh, share);
                        Result r = press_tissue(scene, mesh, 0.004, 300);
                        r.note += fmt::format("; {} of {} tetrahedra are dynamic", upper_part(scene).size(),
                                              mesh.tetrahedra.size());
                        return r;
                      }});
  points.push_back({"hybrid share", "dynamic part", "one tetrahedron at a corner", [] {
                      const TetMesh mesh = small_block_mesh();
                      Scene scene = hybrid_scene(mesh, 0.5);
                      upper_part(scene) = {static_cast<int>(mesh.tetrahedra.size()) - 1};
                      return press_tissue(scene, mesh, 0.004, 300);
                    }});
  return points;
}

}  // namespace palpate::stability
