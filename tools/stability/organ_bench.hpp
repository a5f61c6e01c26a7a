#pragma once
#include "common/archive/archive.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/sim/dynamic_world.hpp"
#include "tools/stability/case.hpp"
#include "tools/study/solid_kinds.hpp"

namespace palpate::stability {

/// Moving tissue under a tool, as the deformation node advances it.
class OrganBench {
 public:
  /// Throws what DynamicOrgan does: std::runtime_error naming the bound for a step that is not stable.
  OrganBench(Scene scene, std::vector<Archive> archives);

  /// One tick with the first tool's tip at p [m].
  void tick(const Eigen::Vector3d& p, double pedal = 0, double grip = 1);
  const DynamicOrgan& organ() const { return world_.organ(0); }
  const Scene& scene() const { return scene_; }
  double dt() const { return world_.dt(); }

  /// Stable while every position is finite; max_force the largest contact force on the tissue [N]; energy_growth how
  /// far the tissue's own energy has risen above the largest of its first `settled` ticks.
  Result result() const;

 private:
  Scene scene_;
  std::vector<Archive> archives_;
  DynamicWorld world_;
  std::uint64_t step_ = 0;
  double largest_ = 0, first_energy_ = 0, late_energy_ = 0, reach_ = 0;
};

/// A small block of moving tissue, base fixed, under a probe; 5 kPa. `body`: of the kind that is wanted.
Scene organ_scene(Body body = TensorMassSpec{});
inline MovingSpec& tissue_of(Scene& scene) {
  return *as<MovingSpec>(scene.bodies[0]);
}
TetMesh organ_mesh(int cells = 4);

/// Pressed to `depth` [m] and left, `ticks` in all.
Result press_organ(const Scene& scene, const TetMesh& mesh, double depth, int ticks);

}  // namespace palpate::stability
