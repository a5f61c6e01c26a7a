#pragma once
#include <concepts>

#include "common/mesh/tet_mesh.hpp"
#include "common/models/body.hpp"
#include "common/scene/scene.hpp"

/// Bodies that studies, stability cases, tests and benchmarks press, and scenes of one of them.
namespace palpate {

/// A block of soft tissue on its bottom, of the kind that is wanted.
template <std::derived_from<SolidSpec> Spec>
Spec block_body(Spec body = {}, double poisson = 0.4) {
  body.name = "block";
  body.material = {.young = 5000, .poisson = poisson, .density = 1000};
  body.fixed.push_back({.where = {.indices = {}, .box = {}, .group = "bottom"}});
  return body;
}

/// 0.1 x 0.1 x 0.05 m times `scale`, its top at z = 0, in half as many cells of height as across.
TetMesh block_mesh(int cells = 6, double scale = 1);
/// The block, quasi-static, and a probe above it along -z.
Scene block_scene(double scale = 1);
/// Of such a scene.
QuasiStaticSpec& block_of(Scene& scene);

/// 40 x 40 x 20 mm on z = 0, in half as many cells of height as across.
TetMesh small_block_mesh(int cells = 4);
/// 60 x 60 x 30 mm on z = 0, in half as many cells of height as across.
TetMesh middle_block_mesh(int cells = 12);
/// An ellipsoid of a kidney's size, 110 x 60 x 45 mm about the origin, and as one of soft tissue on the lowest eighth
/// of its height.
TetMesh kidney_mesh(int cells = 10);
inline constexpr double kKidneyTop = 0.0225;  // [m] z
QuasiStaticSpec kidney_body();

/// One body that moves, and a probe above it along -z.
Scene scene_of_moving(Body body);
/// A block that moves.
template <std::derived_from<MovingSpec> Spec = TensorMassSpec>
Scene moving_block_scene(Spec body = {}, double poisson = 0.4) {
  body = block_body(std::move(body), poisson);
  body.dynamic.damping = 60;
  return scene_of_moving(std::move(body));
}
/// Of such a scene.
MovingSpec& moving_block_of(Scene& scene);

/// A soft tube about the z axis from z = 0 on, clamped at its far end.
inline constexpr double kDuctRadius = 0.0045, kDuctLength = 0.04;  // [m]
ModalShellSpec duct_body(double thickness = 0.001, int modes = 20);

}  // namespace palpate
