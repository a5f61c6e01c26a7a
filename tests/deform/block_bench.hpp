#pragma once
#include <algorithm>

#include "common/models/hybrid/precompute.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/rig/kinds.hpp"
#include "tools/rig/press_rig.hpp"

/// A soft block on a fixed base with a tool above it, for the tests of the deformation node.
namespace palpate::testing {

inline constexpr double kTop = 0.03, kRadius = 0.006;  ///< [m] of the block, z; of the tip

/// [m] A height that goes evenly from one to another in so many ticks, and stays there.
inline double from_above(int tick, int ticks, double from, double to) {
  return from + (to - from) * std::min(1.0, static_cast<double>(tick) / ticks);
}

/// `body`: of the kind that is wanted.
template <class Spec = TensorMassSpec>
Scene block_scene(Spec body = {}) {
  return moving_block_scene(std::move(body), 0.3);
}

/// Moves the tissue under the tools by hand.
class Bench : public PressRig {
 public:
  explicit Bench(const Scene& scene, const TetMesh& mesh = middle_block_mesh())
      : PressRig(scene, {precompute_on(scene.bodies[0], mesh)}) {}
  /// The tensor-mass part has a mesh of its own.
  Bench(const Scene& scene, const TetMesh& mesh, const TetMesh& coarse)
      : PressRig(scene, {precompute(std::get<HybridSpec>(scene.bodies[0]), mesh, &coarse)}) {}
  /// Another one of the same scene and the same tensors, at rest.
  Bench(const Bench& other) : PressRig(other.scene(), other.archives()) {}

  /// One tick with the first tool's tip at height z [m] over the block's base.
  void tick(double z, double x = 0, double pedal = 0, double grip = 1) {
    ToolDofs dofs = tip_at(scene().tools[0], {x, 0, z});
    dofs.pedal = pedal;
    dofs.grip = grip;
    press(std::array{dofs});
  }

  DynamicWorld& world() { return tissue(); }
  bool finite() const {
    for (const Eigen::Vector3d& x : organ().surface().positions())
      if (!x.allFinite()) return false;
    return force().allFinite();
  }
};

}  // namespace palpate::testing
