#include <gtest/gtest.h>

#include "common/contact/patch/hertz_dent.hpp"
#include "common/mesh/normals.hpp"
#include "render_node/stage.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// A plane of two triangles a square, which are twice as long as the radius of what presses.
struct DentedPlane {
  static constexpr int kAcross = 9;
  static constexpr double kEdge = 0.012;

  Scene scene;
  SurfaceMap map;
  HertzDent dent{.middle = {0.004, 0.003, 0},
                 .outward = Vector3d::UnitZ(),
                 .force = {0, 0, -0.1},
                 .disc = 0.004,
                 .reach = 0.04,
                 .half_space = {6000, 0.3}};

  DentedPlane() {
    scene.bodies.resize(1);
    scene.render.emplace();
    for (int i = 0; i < kAcross; ++i)
      for (int j = 0; j < kAcross; ++j) {
        const int n = i * kAcross + j;
        map.position.emplace_back(kEdge * (i - kAcross / 2), kEdge * (j - kAcross / 2), 0);
        map.node_number.push_back(n);
        map.fixed.push_back({false, false, false});
        if (i + 1 == kAcross || j + 1 == kAcross) continue;
        map.triangles.push_back({n, n + kAcross, n + kAcross + 1});
        map.triangles.push_back({n, n + kAcross + 1, n + 1});
      }
    map.touchable = map.size();
  }

  /// As a deformer gives it: the nodes show the dent.
  Stage stage(bool told) const {
    Stage stage(scene, std::span(&map, 1), {});
    std::vector<Vector3f> position, normal;
    for (const Vector3d& p : map.position)
      position.push_back((p + dent.displacement(p, Vector3d::UnitZ())).cast<float>());
    normal.resize(position.size());
    vertex_normals(position, map.triangles, normal);
    stage.set_surface(0, position, normal, told ? std::span(&dent, 1) : std::span<const HertzDent>());
    return stage;
  }

  /// [m] By how far the drawn vertices lie off the dent at most.
  double off(const Stage& stage) const {
    double most = 0;
    const MeshView mesh = stage.frame().meshes[0];
    for (std::size_t v = 0; v < mesh.position.size(); ++v) {
      const Vector3d rest = mesh.rest[v].cast<double>();
      const Vector3d dented = rest + dent.displacement(rest, Vector3d::UnitZ());
      most = std::max(most, (mesh.position[v].cast<double>() - dented).norm());
    }
    return most;
  }
};

TEST(DrawnDent, IsAsRoundBetweenTheNodesAsItIs) {
  const DentedPlane plane;
  EXPECT_LT(plane.off(plane.stage(true)), 1e-7);
  EXPECT_GT(plane.off(plane.stage(false)), 5e-4);  // by the nodes alone it is flatter
}

TEST(DrawnDent, TurnsTheNormalsAlong) {
  const DentedPlane plane;
  const Stage stage = plane.stage(true);
  const MeshView mesh = stage.frame().meshes[0];
  for (std::size_t v = 0; v < mesh.position.size(); ++v) {
    const Vector3d slope = plane.dent.slope(mesh.rest[v].cast<double>(), Vector3d::UnitZ());
    EXPECT_LT((mesh.normal[v].cast<double>() - (Vector3d::UnitZ() - slope).normalized()).norm(), 1e-5);
  }
}

}  // namespace
}  // namespace palpate
