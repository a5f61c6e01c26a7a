#pragma once
#include <limits>

#include "common/mesh/generators.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "common/sim/haptic_step.hpp"
#include "tools/stability/case.hpp"

namespace palpate::stability {

/// Follows a haptic step and says how it went.
class Watch {
 public:
  /// [N m] to a hand, beyond which it counts as unbounded: contacts that pull against one another add up to little
  /// force.
  static constexpr double kMaxTorque = 100;

  /// Looks at the step that has just been made.
  void look(const HapticStep& haptic);
  /// The outcome so far: regularised as soon as any flag was up.
  Result result() const;
  double largest() const { return largest_; }

 private:
  double largest_ = 0, torque_ = 0, max_lost_ = 0;
  bool finite_ = true;
  int steps_ = 0, regularised_ = 0, limited_ = 0, slewed_ = 0, faults_ = 0, stale_ = 0, damped_ = 0;
};

/// A block 0.1 x 0.1 x 0.05 m times `scale`, base fixed, top at z = 0, and a probe above it along -z.
Scene block_scene(double scale = 1);
inline QuasiStaticSpec& block_of(Scene& scene) {
  return *as<QuasiStaticSpec>(scene.bodies[0]);
}
/// The block as moving tissue, which is worked out elsewhere.
void make_moving(Scene& scene);
TetMesh block_mesh(double scale = 1, int cells = 6);

/// Puts the first tool's tip at p, roll as given.
ToolDofs tip_at(const Tool& tool, const Eigen::Vector3d& p, double roll = 0);

/// Precomputes every body with `mesh` and runs the tool's tip through `path` (tip at step i), `steps` steps.
Result press(const Scene& scene, const TetMesh& mesh, const std::function<Eigen::Vector3d(int)>& path, int steps);

/// Down from above to `depth` [m] below the block's top within `ticks`, a while there, and up again.
std::function<Eigen::Vector3d(int)> down_and_up(double above, double depth, int ticks);

}  // namespace palpate::stability
