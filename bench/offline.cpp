// Does a better offline discretisation cost anything at run time? The haptic step of the liver scene with tensors from
// its own mesh and from quadratic locking-free elements, turn and turn about in one run; and what precompute takes.
#include "bench/report.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "common/sim/haptic_step.hpp"
#include "common/tool/trajectory.hpp"

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
void lap(HapticStep& haptic, const Trajectory& motion, bench::Samples& samples) {
  std::vector<ToolDofs> dofs(1);
  for (double t = 0; t < motion.duration(); t += haptic.dt()) {
    dofs[0] = motion.at(t);
    const auto begin = std::chrono::steady_clock::now();
    haptic.step(dofs);
    const auto end = std::chrono::steady_clock::now();
    if (!haptic.force(0).isZero(0)) samples.add(std::chrono::duration<double>(end - begin).count());
  }
}

void measure(const Scene& scene, bool quick) {
  const Trajectory motion = load_trajectory(std::get<ScriptedDeviceSpec>(scene.tools[0].device).trajectory);
  const std::vector<ToolDofs> start{motion.at(0)};
  HapticStep plain(scene, {compute(scene, {}, "liver1400_plain")});
  HapticStep fine(scene, {compute(scene, Offline{0, "p2", "locking_free"}, "liver1400_p2_locking_free")});
  plain.start(start);
  fine.start(start);
  bench::Samples none, of_plain, of_fine;
  lap(plain, motion, none);
  lap(fine, motion, none);
  for (int i = 0; i < (quick ? 2 : 8); ++i) {
    lap(plain, motion, of_plain);
    lap(fine, motion, of_fine);
  }
  bench::report("offline", "liver1400_plain", "step_p50", 1e6 * of_plain.median(), "us");
  bench::report("offline", "liver1400_plain", "step_p99", 1e6 * of_plain.p99(), "us");
  bench::report("offline", "liver1400_p2_locking_free", "step_p50", 1e6 * of_fine.median(), "us");
  bench::report("offline", "liver1400_p2_locking_free", "step_p99", 1e6 * of_fine.p99(), "us");
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::measure(palpate::load_scene(PALPATE_SCENES "/liver.toml"), palpate::bench::quick(argc, argv));
}
