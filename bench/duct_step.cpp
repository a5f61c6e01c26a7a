// What does a haptic step cost with duct, catheter and two forceps, through the whole scripted insertion; and how does
// it grow with modes, with particles, and with the depth of the catheter in the duct?
#include <map>

#include "bench/report.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "common/sim/step_messages.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {
namespace {

constexpr int kMaxModes = 200;

/// The duct with its 200 lowest modes, of which each run keeps the first.
struct Insertion {
  Scene scene = load_scene(PALPATE_SCENES "/catheter_insertion.toml");
  std::vector<Archive> archives;
  std::vector<Trajectory> motions;

  Insertion() {
    for (Body& body : scene.bodies) {
      archives.emplace_back();
      auto* duct = as<ModalShellSpec>(body);
      if (!duct) continue;
      duct->shell.modes = kMaxModes;
      archives.back() = precompute(*duct, load_shell_mesh(duct->mesh, duct->scale));
    }
    for (const Tool& tool : scene.tools)
      motions.push_back(load_trajectory(std::get<ScriptedDeviceSpec>(tool.device).trajectory));
  }
};

struct Timed {
  bench::Samples inside;                   ///< steps with more than 5 mm of catheter in the duct
  std::map<int, bench::Samples> by_depth;  ///< all, by whole millimetres inserted
};

Timed run(const Insertion& whole, int modes, int particles, int every) {
  Scene scene = whole.scene;
  std::vector<Archive> archives = whole.archives;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (auto* wire = as<CatheterSpec>(scene.bodies[b])) wire->catheter.particles = particles;
    if (!as<ModalShellSpec>(scene.bodies[b])) continue;
    ModalTensors& modal = *archives[b].modal;
    modal.shape.resize(modal.shape.size() / modal.omega.size() * modes);
    modal.omega.resize(modes);
  }
  HapticStep haptic(scene, archives);
  std::vector<ToolDofs> dofs;
  for (const Trajectory& m : whole.motions) dofs.push_back(m.at(0));
  haptic.start(dofs);
  Timed timed;
  const double end = std::max(whole.motions[0].duration(), whole.motions[1].duration());
  for (int i = 0; i * haptic.dt() < end; i += every) {
    for (std::size_t t = 0; t < dofs.size(); ++t) dofs[t] = whole.motions[t].at(i * haptic.dt());
    const auto begin = std::chrono::steady_clock::now();
    haptic.step(dofs);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double inserted = task_records(haptic)[0].inserted;
    if (inserted > 0.005) timed.inside.add(seconds);
    timed.by_depth[static_cast<int>(1e3 * inserted)].add(seconds);
  }
  return timed;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  using namespace palpate;
  const bool quick = bench::quick(argc, argv);
  const Insertion insertion;
  run(insertion, 50, 60, 20);  // warm
  const Timed whole = run(insertion, 50, 60, 1);
  bench::report("duct_step", "insertion", "p50", 1e6 * whole.inside.median(), "us");
  bench::report("duct_step", "insertion", "p99", 1e6 * whole.inside.p99(), "us");
  bench::report("duct_step", "insertion", "p999", 1e6 * whole.inside.p999(), "us");
  bench::report("duct_step", "insertion", "max", 1e6 * whole.inside.max(), "us");
  for (const auto& [depth, samples] : whole.by_depth)
    if (samples.size() >= 20)
      bench::report("duct_step", fmt::format("depth{:02}mm", depth), "p50", 1e6 * samples.median(), "us");
  if (quick) return 0;
  for (int modes : {10, 25, 50, 100, 150, 200})
    bench::report("duct_step", fmt::format("modes{:03}", modes), "p50",
                  1e6 * run(insertion, modes, 60, 1).inside.median(), "us");
  for (int particles : {30, 60, 90, 120, 180, 240})
    bench::report("duct_step", fmt::format("particles{:03}", particles), "p50",
                  1e6 * run(insertion, 50, particles, 1).inside.median(), "us");
}
