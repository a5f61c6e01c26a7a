#include "tools/rig/example_bodies.hpp"

#include <algorithm>

#include "common/mesh/generators.hpp"

namespace palpate {

TetMesh block_mesh(int cells, double scale) {
  return make_block(scale * Eigen::Vector3d(-0.05, -0.05, -0.05), scale * Eigen::Vector3d(0.05, 0.05, 0),
                    {cells, cells, cells / 2});
}

Scene block_scene(double scale) {
  Scene scene;
  scene.bodies.push_back(block_body<QuasiStaticSpec>());
  Tool tool;
  tool.name = "probe";
  tool.pivot = {0, 0, 0.2 * scale};
  std::get<ProbeSpec>(tool.end).radius = 0.008 * scale;
  tool.shaft_radius = 0.0025 * scale;
  tool.shaft_length = 0.3 * scale;
  scene.tools.push_back(tool);
  return scene;
}

QuasiStaticSpec& block_of(Scene& scene) {
  return std::get<QuasiStaticSpec>(scene.bodies[0]);
}

TetMesh small_block_mesh(int cells) {
  return make_block({-0.02, -0.02, 0}, {0.02, 0.02, 0.02}, {cells, cells, std::max(1, cells / 2)});
}

TetMesh middle_block_mesh(int cells) {
  return make_block({-0.03, -0.03, 0}, {0.03, 0.03, 0.03}, {cells, cells, cells / 2});
}

TetMesh kidney_mesh(int cells) {
  TetMesh mesh = make_block({-1, -1, -1}, {1, 1, 1}, {cells, cells, cells});
  for (Eigen::Vector3d& x : mesh.nodes) {  // the cube's shells become ellipsoids
    const double size = x.norm();
    if (size > 0) x *= x.cwiseAbs().maxCoeff() / size;
    x = x.cwiseProduct(Eigen::Vector3d(0.055, 0.03, kKidneyTop));
  }
  return mesh;
}

QuasiStaticSpec kidney_body() {
  QuasiStaticSpec body;
  body.name = "kidney";
  body.material = {.young = 6000, .poisson = 0.45, .density = 1000};
  body.fixed.push_back({.where = {.indices = {}, .box = Box{{-1, -1, -1}, {1, 1, -0.75 * kKidneyTop}}, .group = {}}});
  return body;
}

Scene scene_of_moving(Body body) {
  Scene scene;
  scene.bodies.push_back(std::move(body));
  Tool tool;
  tool.name = "probe";
  tool.pivot = {0, 0, 0.3};
  std::get<ProbeSpec>(tool.end).radius = 0.006;
  tool.shaft_length = 0.01;
  scene.tools.push_back(tool);
  return scene;
}

MovingSpec& moving_block_of(Scene& scene) {
  return *as<MovingSpec>(scene.bodies[0]);
}

ModalShellSpec duct_body(double thickness, int modes) {
  ModalShellSpec duct;
  duct.name = "duct";
  duct.material = {.young = 200e3, .poisson = 0.45, .density = 1000};
  duct.shell = {.thickness = thickness, .modes = modes};
  duct.fixed.push_back({{.where = {.indices = {}, .box = Box{{-1, -1, kDuctLength - 1e-6}, {1, 1, 1}}, .group = {}}}});
  return duct;
}

}  // namespace palpate
