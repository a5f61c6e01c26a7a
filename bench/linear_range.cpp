// How wrong linear elasticity is by how far a press goes, against neo-Hookean tissue on the same mesh with the same
// contact; beside it what the range monitor sees of the linear answer. From these rows come its thresholds.
#include "bench/only.hpp"
#include "bench/report.hpp"
#include "common/fem/newton_solid.hpp"
#include "common/fem/processor_blas.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/surface.hpp"
#include "common/mesh/surface_change.hpp"
#include "common/models/quasi_static/press_spots.hpp"
#include "common/models/solid/precompute.hpp"
#include "common/scene/scene.hpp"
#include "tools/rig/example_bodies.hpp"

namespace palpate {
namespace {

constexpr double kRadius = 0.006;                                                // [m]
constexpr double kDepths[] = {0.125, 0.25, 0.5, 0.75, 1, 1.5, 2, 2.5, 3, 4, 5};  // of the radius
constexpr NewtonSolid::Stepping kStepping{.max_halvings = 3};

/// [1] difference of two fields in the mean square over a surface's area.
double difference(const std::vector<double>& area, const PressState& a, const PressState& truth) {
  double of = 0, size = 0;
  for (std::size_t n = 0; n < area.size(); ++n) {
    of += area[n] * (a.displacement[n] - truth.displacement[n]).squaredNorm();
    size += area[n] * truth.displacement[n].squaredNorm();
  }
  return std::sqrt(of / size);
}

void press(const std::string& name, const SolidSpec& body, const TetMesh& mesh, bool quick) {
  const StaticProblem problem = make_static_problem(body, mesh);
  const SurfaceMap map = make_surface_map(body, problem.mesh, problem.dofs);
  const SurfaceAtRest rest(map.position, map.triangles);
  const PressedSpot spot = choose_spots(map, kRadius, 1).front();
  int strides = 0;
  const StaticProblem fine = refine_under_ball(problem, std::array{spot}, {1, 0.25, 0.6, 4000}, strides);
  const std::vector<double> area = node_areas(fine.mesh.nodes, extract_surface(fine.mesh).triangles);
  NewtonSolid linear(fine, Law::linear), truth(fine, Law::neo_hookean);
  const auto ball = [&](double depth) { return Sphere{spot.point + (depth - kRadius) * spot.inward, kRadius}; };
  double before = 0;
  for (const double share : kDepths) {
    if (quick && share > 0.5) break;
    const double depth = share * kRadius;
    try {
      const PressState l = linear.press(ball(before), ball(depth), kStepping);
      const PressState t = truth.press(ball(before), ball(depth), kStepping);
      std::vector<Eigen::Vector3f> position;
      for (int n = 0; n < map.size(); ++n)
        position.push_back((map.position[n] + l.displacement[map.node_number[n]]).cast<float>());
      const SurfaceChange seen = rest.change(position);
      const std::string at = fmt::format("{}_{}R", name, share);
      bench::report("linear_range", at, "force_error", l.force.norm() / t.force.norm() - 1, "1");
      bench::report("linear_range", at, "displacement_error", difference(area, l, t), "1");
      bench::report("linear_range", at, "stretch", seen.stretch, "1");
      bench::report("linear_range", at, "rotation", 57.29577951 * seen.rotation, "deg");
      bench::report("linear_range", at, "volume", seen.volume, "1");
    } catch (const std::runtime_error&) {
      bench::report("linear_range", name, "no_equilibrium_beyond", before, "m");
      return;
    }
    before = depth;
  }
}

void press_scene(const std::string& name, bool quick) {
  const Scene scene = load_scene(fmt::format("{}/{}.toml", PALPATE_SCENES, name));
  const auto& body = std::get<QuasiStaticSpec>(scene.bodies[0]);
  press(name, body, load_tet_mesh(body.mesh, body.scale), quick);
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::use_blas_of_this_processor(argv);
  using palpate::bench::is_asked_for;
  const bool quick = palpate::bench::quick(argc, argv);
  if (is_asked_for("kidney", argc, argv))
    palpate::press("kidney", palpate::kidney_body(), palpate::kidney_mesh(), quick);
  for (const char* scene : {"liver", "plate", "brain_cylinder"})
    if (is_asked_for(scene, argc, argv)) palpate::press_scene(scene, quick);
}
