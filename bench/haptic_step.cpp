// What does a whole haptic step cost: collision, one contact, force; with 64 held nodes; and its hand-over?
#include <cmath>

#include "bench/report.hpp"
#include "common/realtime/spsc_ring.hpp"
#include "common/tensors/ensure_archive.hpp"
#include "common/tool/trajectory.hpp"
#include "haptic_node/step_record.hpp"

namespace palpate {
namespace {

/// The scripted motion of the liver scene; steps in contact are sampled, and their hand-over to the ring.
void one_contact(const Scene& scene, const std::vector<Archive>& archives, bool quick) {
  HapticStep haptic(scene, archives);
  const Trajectory motion = load_trajectory(scene.tools[0].trajectory);
  SpscRing<StepRecord> ring(64);
  bench::Samples steps, pushes;
  std::vector<ToolDofs> dofs(haptic.tools());
  for (int lap = 0; lap < (quick ? 2 : 6); ++lap) {
    dofs[0] = motion.at(0);
    if (lap == 0) haptic.start(dofs);
    for (double t = 0; t < motion.duration(); t += haptic.dt()) {
      dofs[0] = motion.at(t);
      const auto begin = std::chrono::steady_clock::now();
      haptic.step(dofs);
      const auto stepped = std::chrono::steady_clock::now();
      const std::array<DeviceSample, 1> samples{DeviceSample{dofs[0], 0}};
      StepRecord* record = ring.begin_push();
      fill_record(haptic, samples, 0, 0, *record);
      ring.commit_push();
      const auto pushed = std::chrono::steady_clock::now();
      if (ring.begin_pop()) ring.commit_pop();
      if (haptic.force(0).isZero(0) || lap == 0) continue;
      steps.add(std::chrono::duration<double>(stepped - begin).count());
      pushes.add(std::chrono::duration<double>(pushed - stepped).count());
    }
  }
  bench::report("haptic_step", "liver1400_contact1", "p50", 1e6 * steps.median(), "us");
  bench::report("haptic_step", "liver1400_contact1", "p99", 1e6 * steps.p99(), "us");
  bench::report("haptic_step", "liver1400_contact1", "p999", 1e6 * steps.p999(), "us");
  bench::report("haptic_step", "liver1400_contact1", "max", 1e6 * steps.max(), "us");
  bench::report("publish", "haptic_step", "p50", 1e6 * pushes.median(), "us");
  bench::report("publish", "haptic_step", "p999", 1e6 * pushes.p999(), "us");
}

int held_nodes(const HapticStep& haptic) {
  int held = 0;
  for (const TouchContact& c : haptic.body(0).law().contacts()) held += c.touch != Touch::open;
  return held;
}

/// A ball of 1 m presses the liver from above until 64 nodes are held, and trembles there: more
/// come to be held as the contact settles, and their mean number is a row of its own.
void many_contacts(Scene scene, const std::vector<Archive>& archives, bool quick) {
  Tool& tool = scene.tools[0];
  tool.radius = 1.0;
  tool.shaft_length = 1.0;
  tool.pivot = {0, 0, 1.5};
  tool.axis = -Eigen::Vector3d::UnitZ();
  tool.up = Eigen::Vector3d::UnitY();
  scene.tools.resize(1);
  scene.contact.friction = 10;  // all stick, so that all three displacements of every node are held
  HapticStep haptic(scene, archives);
  ToolDofs dofs;
  dofs.depth = 0.4;
  haptic.start(std::array{dofs});
  for (int i = 0; held_nodes(haptic) < 64 && i < 100000; ++i) {
    dofs.depth += 2e-6;
    haptic.step(std::array{dofs});
  }
  const double depth = dofs.depth;
  double held = 0;
  bench::Samples samples;
  const int count = quick ? 2000 : 20000;
  samples.measure(200, count, [&](int i) {
    dofs.depth = depth + 2e-6 * std::sin(0.05 * i);
    haptic.step(std::array{dofs});
    if (i >= 0) held += held_nodes(haptic);
  });
  bench::report("held_nodes", "liver1400_64", "held", held / count, "nodes");
  bench::report("held_nodes", "liver1400_64", "p50", 1e6 * samples.median(), "us");
  bench::report("held_nodes", "liver1400_64", "p999", 1e6 * samples.p999(), "us");
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  const bool quick = palpate::bench::quick(argc, argv);
  const palpate::Scene scene = palpate::load_scene(PALPATE_SCENES "/liver.toml");
  const auto archives = palpate::load_or_precompute(scene, palpate::ArchivePart::touchable);
  palpate::one_contact(scene, archives, quick);
  palpate::many_contacts(scene, archives, quick);
}
