#pragma once
#include "common/mesh/generators.hpp"
#include "common/tensors/precompute.hpp"
#include "common/tensors/precompute_dynamic.hpp"
#include "deform_node/dynamic_world.hpp"

/// A soft block on a fixed base with a tool above it, for the tests of the deformation node.
namespace palpate::testing {

inline Scene block_scene(const std::string& model = "tensor_mass") {
  Scene scene;
  Body body;
  body.name = "block";
  body.model = model;
  body.material = {5000, 0.3, 1000};
  body.fixed.push_back({.where = {.indices = {}, .box = {}, .group = "bottom"}});
  body.dynamic.damping = 60;
  scene.bodies.push_back(body);
  Tool tool;
  tool.name = "probe";
  tool.pivot = {0, 0, 0.3};
  tool.axis = -Eigen::Vector3d::UnitZ();
  tool.up = Eigen::Vector3d::UnitY();
  tool.radius = 0.006;
  tool.shaft_length = 0.01;
  scene.tools.push_back(tool);
  return scene;
}

/// 60 x 60 x 30 mm, cells of 5 mm; its top at z = 30 mm.
inline TetMesh block_mesh() {
  return make_block({-0.03, -0.03, 0}, {0.03, 0.03, 0.03}, {12, 12, 6});
}

/// Moves the tools of a world by hand.
class Bench {
 public:
  explicit Bench(Scene scene, const TetMesh& mesh = block_mesh())
      : Bench(std::move(scene), [&](const Body& body) { return precompute(body, mesh); }) {}
  /// A hybrid whose tensor-mass part has a mesh of its own.
  Bench(Scene scene, const TetMesh& mesh, const TetMesh& coarse)
      : Bench(std::move(scene), [&](const Body& body) { return precompute_dynamic(body, mesh, &coarse); }) {}

  /// Another one of the same scene and the same tensors, at rest.
  explicit Bench(const Bench& other) : scene_(other.scene_), archives_(other.archives_), world_(scene_, archives_) {}

  /// One tick with the first tool's tip at height z [m] over the block's base.
  void tick(double z, double x = 0, double pedal = 0, double grip = 1) {
    const Trocar trocar = make_trocar(scene_.tools[0].pivot, scene_.tools[0].axis, scene_.tools[0].up);
    const ToolDofs d = dofs_for_tip(trocar, {x, 0, z}, 0);
    ToolState s{.run = 7,
                .step = ++step_,
                .sense_ns = static_cast<std::int64_t>(step_),
                .yaw = d.yaw,
                .pitch = d.pitch,
                .depth = d.depth,
                .roll = 0,
                .grip = grip};
    s.pedal = pedal;
    world_.take(s);
    world_.tick();
  }

  DynamicWorld& world() { return world_; }
  const DynamicOrgan& organ() const { return world_.organ(0); }
  const Scene& scene() const { return scene_; }
  const std::vector<Archive>& archives() const { return archives_; }

  /// [N] on the tissue, of all contacts.
  Eigen::Vector3d force() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const TissueContact& c : organ().contacts()) sum += c.force;
    return sum;
  }
  bool finite() const {
    for (const Eigen::Vector3d& x : organ().surface().positions())
      if (!x.allFinite()) return false;
    return force().allFinite();
  }

 private:
  template <class Make>
  Bench(Scene scene, Make&& make)
      : scene_(std::move(scene)), archives_{make(scene_.bodies[0])}, world_(scene_, archives_) {}

  Scene scene_;
  std::vector<Archive> archives_;
  DynamicWorld world_;
  std::uint64_t step_ = 0;
};

}  // namespace palpate::testing
