#pragma once
#include "common/mesh/generators.hpp"
#include "common/models/hybrid/precompute.hpp"
#include "common/models/moving/precompute.hpp"
#include "common/sim/dynamic_world.hpp"

/// A soft block on a fixed base with a tool above it, for the tests of the deformation node.
namespace palpate::testing {

/// `body`: of the kind that is wanted.
template <class Spec = TensorMassSpec>
Scene block_scene(Spec body = {}) {
  Scene scene;
  body.name = "block";
  body.material = {5000, 0.3, 1000};
  body.fixed.push_back({.where = {.indices = {}, .box = {}, .group = "bottom"}});
  body.dynamic.damping = 60;
  scene.bodies.push_back(body);
  Tool tool;
  tool.name = "probe";
  tool.pivot = {0, 0, 0.3};
  tool.axis = -Eigen::Vector3d::UnitZ();
  tool.up = Eigen::Vector3d::UnitY();
  tool.probe()->radius = 0.006;
  tool.shaft_length = 0.01;
  scene.tools.push_back(tool);
  return scene;
}

/// The block of a scene.
inline MovingSpec& block_of(Scene& scene) {
  return *as<MovingSpec>(scene.bodies[0]);
}

/// The block's archive. `coarse`: the mesh of a hybrid's tensor-mass part that has one of its own.
inline Archive precompute_block(const Scene& scene, const TetMesh& mesh, const TetMesh* coarse) {
  const Body& body = scene.bodies[0];
  if (const auto* hybrid = as<HybridSpec>(body)) return precompute(*hybrid, mesh, coarse);
  return precompute_moving(*as<MovingSpec>(body), kind_of(body), mesh);
}

/// 60 x 60 x 30 mm, cells of 5 mm; its top at z = 30 mm.
inline TetMesh block_mesh() {
  return make_block({-0.03, -0.03, 0}, {0.03, 0.03, 0.03}, {12, 12, 6});
}

/// Moves the tools of a world by hand.
class Bench {
 public:
  explicit Bench(Scene scene, const TetMesh& mesh = block_mesh(), const TetMesh* coarse = nullptr)
      : scene_(std::move(scene)), archives_{precompute_block(scene_, mesh, coarse)}, world_(scene_, archives_) {}

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
    const auto& jaws = scene_.tools[0].probe()->jaws;
    s.holding = jaws && grip < jaws->closed_below;
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
    for (const TouchContact& c : organ().contacts()) sum += c.force;
    return sum;
  }
  bool finite() const {
    for (const Eigen::Vector3d& x : organ().surface().positions())
      if (!x.allFinite()) return false;
    return force().allFinite();
  }

 private:
  Scene scene_;
  std::vector<Archive> archives_;
  DynamicWorld world_;
  std::uint64_t step_ = 0;
};

}  // namespace palpate::testing
