// What does a haptic step cost with duct, catheter and two forceps, through the whole scripted insertion; and how does
// it grow with modes, with particles, and with the depth of the catheter in the duct?
#include <map>

#include "bench/report.hpp"
#include "common/fem/processor_blas.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "tools/rig/press_rig.hpp"
#include "tools/rig/scripted_tools.hpp"

namespace palpate {
namespace {

constexpr int kMaxModes = 200;

// What a scene needs of each body: the duct has its 200 lowest modes, of which each run keeps the first.
void compute(NamedSpec&, Archive&) {}
void compute(ModalShellSpec& duct, Archive& archive) {
  duct.shell.modes = kMaxModes;
  archive = precompute(duct, load_shell_mesh(duct.mesh, duct.scale));
}

struct Sizes {
  int modes, particles;
};
void resize(NamedSpec&, Archive&, const Sizes&) {}
void resize(ModalShellSpec&, Archive& archive, const Sizes& sizes) {
  ModalTensors& modal = *archive.modal;
  modal.shape.resize(modal.shape.size() / modal.omega.size() * sizes.modes);
  modal.omega.resize(sizes.modes);
}
void resize(CatheterSpec& wire, Archive& archive, const Sizes& sizes) {
  wire.catheter.particles = sizes.particles;
  archive = *made_archive(wire);
}

struct Insertion {
  Scene scene = load_scene(PALPATE_SCENES "/catheter_insertion.toml");
  std::vector<Archive> archives{scene.bodies.size()};

  Insertion() {
    for (std::size_t b = 0; b < archives.size(); ++b)
      std::visit([&](auto& spec) { compute(spec, archives[b]); }, scene.bodies[b]);
  }
};

struct Timed {
  bench::Samples inside;                   ///< steps with more than 5 mm of catheter in the duct
  std::map<int, bench::Samples> by_depth;  ///< all, by whole millimetres inserted
};

Timed run(const Insertion& whole, int modes, int particles, int every) {
  Scene scene = whole.scene;
  std::vector<Archive> archives = whole.archives;
  for (std::size_t b = 0; b < archives.size(); ++b)
    std::visit([&](auto& spec) { resize(spec, archives[b], {modes, particles}); }, scene.bodies[b]);
  PressRig rig(scene, std::move(archives));
  ScriptedTools tools(scene);
  rig.start(tools.at(0));
  Timed timed;
  for (int i = 0; i * rig.dt() < tools.duration(); i += every) {
    const auto dofs = tools.at(i * rig.dt());
    const auto begin = std::chrono::steady_clock::now();
    rig.press(dofs);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double inserted = rig.simulator().tasks()[0].inserted;
    if (inserted > 0.005) timed.inside.add(seconds);
    timed.by_depth[static_cast<int>(1e3 * inserted)].add(seconds);
  }
  return timed;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::use_blas_of_this_processor(argv);
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
