// Does a better offline discretisation cost anything at run time? The haptic step of the liver scene with tensors from
// its own mesh and from quadratic locking-free elements, turn and turn about in one run; and what precompute takes.
#include "bench/report.hpp"
#include "common/fem/processor_blas.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "tools/rig/press_rig.hpp"
#include "tools/rig/scripted_tools.hpp"

namespace palpate {
namespace {

Archive compute(const Scene& scene, std::optional<Offline> offline, const char* name) {
  auto body = std::get<QuasiStaticSpec>(scene.bodies[0]);
  body.offline = offline;
  const auto mesh = load_tet_mesh(body.mesh, body.scale);
  const auto begin = std::chrono::steady_clock::now();
  Archive archive = precompute(body, mesh);
  bench::report("offline", name, "precompute",
                std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), "s");
  bench::report("offline", name, "tensors", static_cast<double>(archive.touchable_compliance.size() * sizeof(double)),
                "B");
  return archive;
}

/// Times the steps in contact of one lap of the scene's scripted motion.
void lap(PressRig& rig, ScriptedTools& tools, bench::Samples& samples) {
  for (double t = 0; t < tools.duration(); t += rig.dt()) {
    const auto dofs = tools.at(t);
    const auto begin = std::chrono::steady_clock::now();
    rig.press(dofs);
    const auto end = std::chrono::steady_clock::now();
    if (!rig.force().isZero(0)) samples.add(std::chrono::duration<double>(end - begin).count());
  }
}

void measure(const Scene& scene, bool quick) {
  ScriptedTools tools(scene);
  PressRig plain(scene, {compute(scene, {}, "liver1400_plain")});
  PressRig fine(
      scene, {compute(scene, Offline{0, FiniteElement::p2, Formulation::locking_free}, "liver1400_p2_locking_free")});
  plain.start(tools.at(0));
  fine.start(tools.at(0));
  bench::Samples none, of_plain, of_fine;
  lap(plain, tools, none);
  lap(fine, tools, none);
  for (int i = 0; i < (quick ? 2 : 8); ++i) {
    lap(plain, tools, of_plain);
    lap(fine, tools, of_fine);
  }
  bench::report("offline", "liver1400_plain", "step_p50", 1e6 * of_plain.median(), "us");
  bench::report("offline", "liver1400_plain", "step_p99", 1e6 * of_plain.p99(), "us");
  bench::report("offline", "liver1400_p2_locking_free", "step_p50", 1e6 * of_fine.median(), "us");
  bench::report("offline", "liver1400_p2_locking_free", "step_p99", 1e6 * of_fine.p99(), "us");
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::use_blas_of_this_processor(argv);
  palpate::measure(palpate::load_scene(PALPATE_SCENES "/liver.toml"), palpate::bench::quick(argc, argv));
}
