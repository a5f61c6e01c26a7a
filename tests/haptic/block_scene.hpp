#pragma once
#include "common/models/quasi_static/precompute.hpp"
#include "common/scene/scene.hpp"
#include "common/sim/haptic_step.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/rig/tip_at.hpp"

namespace palpate::testing {

/// A block 0.1 x 0.1 x 0.05 m, top in the plane z = 0, base fixed, under tools that come down along -z from 0.2 m
/// above: a tool's depth is 0.2 m minus the height of its tip.
struct BlockScene {
  Scene scene;
  std::vector<Archive> archives;

  explicit BlockScene(int tools = 1, int cells = 8) {
    const TetMesh mesh = block_mesh(cells);
    QuasiStaticSpec body;
    body.name = "block";
    body.material = {.young = 5000, .poisson = 0.4, .density = 1000};
    body.fixed.push_back({.where = {.box = Box{{-1, -1, -0.0501}, {1, 1, -0.0499}}}});
    scene.bodies.push_back(body);
    scene.contact.rule = ContactRule::barycentric;
    for (int t = 0; t < tools; ++t) {
      Tool tool;
      tool.name = "probe" + std::to_string(t);
      tool.pivot = {0.02 * t, 0, 0.2};
      std::get<ProbeSpec>(tool.end).radius = 0.008;
      tool.max_force = 100;
      tool.max_force_rate = 1e6;
      scene.tools.push_back(tool);
    }
    archives.push_back(precompute(body, mesh));
  }
};

/// A scene whose only body is moving tissue, under a tool that comes down along -z as in BlockScene; without friction.
/// A haptic step takes it with one empty archive.
inline Scene moving_block_scene(double radius) {
  Scene scene;
  TensorMassSpec body;
  body.name = "block";
  scene.bodies.push_back(body);
  Tool tool;
  tool.name = "probe";
  tool.pivot = {0, 0, 0.2};
  std::get<ProbeSpec>(tool.end).radius = radius;
  tool.max_force = 100;
  tool.max_force_rate = 1e6;
  scene.tools.push_back(tool);
  scene.contact.friction = 0;
  return scene;
}

}  // namespace palpate::testing
