// What compressed tensors cost and how far they are from the dense ones, over the fineness of the liver: seconds of
// processor, megabytes, the haptic step and the superposition of the deformation node. Meshes of its liver that are
// there already may be given: bench_compressed [--quick] [MESH...]
#include <sys/resource.h>
#include <time.h>

#include <algorithm>

#include "bench/report.hpp"
#include "common/archive/load_sum.hpp"
#include "common/fem/processor_blas.hpp"
#include "common/fem/surface_columns.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "common/models/solid/precompute.hpp"
#include "tools/generate/liver.hpp"
#include "tools/rig/press_rig.hpp"
#include "tools/rig/scripted_tools.hpp"

namespace palpate {
namespace {

double processor_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * t.tv_usec; };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Largest entry by which the columns of some nodes are off, over what a node moves under its own force.
double error_of(const Archive& archive, const SurfaceColumns& columns, int sample) {
  const Compliance<double> compliance(archive, Compliance<double>::Rows::surface);
  double worst = 0, own = 0;
  for (int s = 0; s < sample; ++s) {
    const int node = (2 * s + 1) * archive.surface.touchable / (2 * sample);
    const Eigen::MatrixXd exact = columns(std::array{node});
    own += exact.middleRows<3>(3 * node).trace() / 3 / sample;
    for (int i = 0; i < compliance.row_nodes(); ++i)
      worst = std::max(worst, (exact.middleRows<3>(3 * i) - compliance.block(i, node)).cwiseAbs().maxCoeff());
  }
  return worst / own;
}

/// [s] That this thread has had a processor: what else the machine does is left out.
double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The haptic step of the liver scene's motion, in contact, in processor time.
void measure_step(const Scene& scene, const Archive& archive, const std::string& name, bool quick) {
  ScriptedTools tools(scene);
  PressRig rig(scene, {archive});
  rig.start(tools.at(0));
  bench::Samples steps;
  for (int lap = 0; lap < (quick ? 2 : 6); ++lap)
    for (double t = 0; t < tools.duration(); t += rig.dt()) {
      const auto dofs = tools.at(t);
      const double begin = thread_seconds();
      rig.press(dofs);
      const double end = thread_seconds();
      if (lap > 0 && !rig.force().isZero(0)) steps.add(end - begin);
    }
  const std::string form = archive.compressed ? "step" : "step_dense";
  bench::report("compressed", name, form + "_p50", 1e6 * steps.median(), "us");
  bench::report("compressed", name, form + "_p99", 1e6 * steps.p99(), "us");
  bench::report("compressed", name, form + "_p999", 1e6 * steps.p999(), "us");
}

/// Thirty nodes are loaded, next to one another: the whole surface follows.
void measure_superposition(const Archive& archive, const std::string& name) {
  const Compliance<float> compliance(archive, Compliance<float>::Rows::surface);
  LoadSum<float> sum(compliance, 30);
  std::vector<float> u(3 * static_cast<std::size_t>(compliance.row_nodes()));
  bench::Samples samples;
  for (int i = 0; i < 50; ++i) {
    const double begin = thread_seconds();
    sum.clear();
    for (int k = 0; k < 30; ++k) sum.add(k, {0.01f, 0, -0.1f});
    sum.everywhere(u);
    bench::keep(u);
    samples.add(thread_seconds() - begin);
  }
  bench::report("compressed", name, "superposition", 1e6 * samples.median(), "us");
}

void measure(const Scene& scene, const TetMesh& mesh, bool quick) {
  const auto body = with_offline(std::get<QuasiStaticSpec>(scene.bodies[0]), mesh);
  const auto wall = std::chrono::steady_clock::now();
  const double used = processor_seconds();
  const Archive archive = precompute(body, mesh, nullptr, {}, Route::fastest, nullptr, TensorForm::compressed);
  const double seconds = processor_seconds() - used;
  const std::string name = fmt::format("liver{}", archive.surface.size());
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - wall;
  bench::report("compressed", name, "mesh_nodes", static_cast<double>(mesh.nodes.size()), "1");
  bench::report("compressed", name, "precompute_wall", taken.count(), "s");
  bench::report("compressed", name, "precompute_processor", seconds, "s");
  const double t = static_cast<double>(archive.touchable_dofs.size());
  bench::report("compressed", name, "tensors", 1e-6 * static_cast<double>(archive.compressed->bytes()), "MB");
  bench::report("compressed", name, "tensors_dense", 1e-6 * 8 * t * (t + 1) / 2, "MB");
  const auto dofs = apply_boundary_conditions(mesh, body.fixed, body.name);
  const auto materials = material_field(body, mesh);
  const SurfaceColumns columns =
      is_finer(body.offline) ? SurfaceColumns(make_fine_problem(mesh, *body.offline, materials, dofs, body.name),
                                              archive.surface.node_number, 0)
                             : SurfaceColumns(mesh, materials, dofs, archive.surface.node_number);
  bench::report("compressed", name, "error", error_of(archive, columns, quick ? 8 : 32), "1");
  measure_step(scene, archive, name, quick);
  measure_superposition(archive, name);
  if (form_of(archive.surface.touchable) == TensorForm::dense) measure_step(scene, precompute(body, mesh), name, quick);
}

void run(int argc, char** argv) {
  const bool quick = bench::quick(argc, argv);
  const Scene scene = load_scene(PALPATE_SCENES "/liver.toml");
  bool given = false;
  for (const std::string argument : std::span(argv + 1, argv + argc)) {
    if (argument == "--quick") continue;
    measure(scene, load_tet_mesh(argument, 1), quick);
    given = true;
  }
  if (given) return;
  constexpr double kSphere = 0.104;  // [m] edges of the liver's surface times the frequency of its sphere
  for (const int frequency : quick ? std::vector{8, 12} : std::vector{8, 12, 17, 27})
    measure(scene, make_liver({.frequency = frequency, .inner_size = 2.5 * kSphere / frequency}), quick);
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) try {
  palpate::use_blas_of_this_processor(argv);
  palpate::run(argc, argv);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_compressed: %s\n", error.what());
  return 1;
}
