// What does a whole haptic step cost: collision, one contact, force; with 64 held nodes; and its hand-over?
#include <cmath>

#include "bench/report.hpp"
#include "bench/shaft_block.hpp"
#include "common/realtime/spsc_ring.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/tool/motion_guard.hpp"
#include "tools/rig/press_rig.hpp"
#include "tools/rig/scripted_tools.hpp"

namespace palpate {
namespace {

void report_steps(const char* name, const bench::Samples& steps) {
  bench::report("haptic_step", name, "p50", 1e6 * steps.median(), "us");
  bench::report("haptic_step", name, "p99", 1e6 * steps.p99(), "us");
  bench::report("haptic_step", name, "p999", 1e6 * steps.p999(), "us");
  bench::report("haptic_step", name, "max", 1e6 * steps.max(), "us");
}

/// The scripted motion of the liver scene; steps in contact are sampled. Returns their hand-over to the ring.
bench::Samples one_contact(const Scene& scene, const std::vector<Archive>& archives, const char* name, bool quick) {
  PressRig rig(scene, archives);
  ScriptedTools tools(scene);
  SpscRing<StepRecord> ring(64);
  ring.for_each_slot([&](StepRecord& slot) { prepare_record(rig.haptic(), slot); });
  bench::Samples steps, pushes;
  rig.start(tools.at(0));
  for (int lap = 0; lap < (quick ? 2 : 6); ++lap) {
    for (double t = 0; t < tools.duration(); t += rig.dt()) {
      const auto dofs = tools.at(t);
      const auto begin = std::chrono::steady_clock::now();
      rig.press(dofs);
      const auto stepped = std::chrono::steady_clock::now();
      const std::array<DeviceSample, 1> samples{DeviceSample{dofs[0], 0}};
      StepRecord* record = ring.begin_push();
      fill_record(rig.haptic(), samples, 0, 0, *record);
      ring.commit_push();
      const auto pushed = std::chrono::steady_clock::now();
      if (ring.begin_pop()) ring.commit_pop();
      if (rig.force().isZero(0) || lap == 0) continue;
      steps.add(std::chrono::duration<double>(stepped - begin).count());
      pushes.add(std::chrono::duration<double>(pushed - stepped).count());
    }
  }
  report_steps(name, steps);
  return pushes;
}

/// The same tissue, which relaxes.
Scene relaxing(Scene scene) {
  as<QuasiStaticSpec>(scene.bodies[0])->relaxation = Relaxation{{0.5, 5}, {0.3, 0.2}};
  return scene;
}

Scene by_nodes(Scene scene) {
  scene.contact.rule = ContactRule::barycentric;
  return scene;
}

/// Eight balls of 0.1 m press the liver from all sides until they hold 64 nodes together, and tremble there.
void many_contacts(Scene scene, const std::vector<Archive>& archives, bool quick) {
  constexpr int wanted = 64;
  constexpr double radius = 0.1;
  const Eigen::Vector3d centre(0.007, 0, 0);
  Tool tool = scene.tools[0];
  std::get<ProbeSpec>(tool.end).radius = radius;
  tool.shaft_length = 0.5 * radius;
  tool.up = Eigen::Vector3d::UnitZ();
  scene.tools.clear();
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d side(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    tool.name = fmt::format("ball{}", corner);
    tool.axis = -side.normalized();
    tool.pivot = centre - tool.axis;
    scene.tools.push_back(tool);
  }
  scene = by_nodes(scene);
  scene.contact.friction = 10;  // all stick, so that all three displacements of every node are held
  PressRig rig(scene, archives);
  std::vector<ToolDofs> dofs(scene.tools.size());
  for (ToolDofs& d : dofs) d.depth = 0.5;
  rig.start(dofs);
  const auto held_by = [&](int tool) { return held_points(rig.haptic(), 0, tool); };
  for (int i = 0; held_points(rig.haptic(), 0) < wanted && i < 300000; ++i) {
    int least = 0;
    for (int t = 1; t < static_cast<int>(dofs.size()); ++t)
      if (held_by(t) < held_by(least)) least = t;
    dofs[least].depth += 1e-5;
    rig.press(dofs);
  }
  const std::vector<ToolDofs> pressed = dofs;
  double held = 0;
  bench::Samples samples;
  const int count = quick ? 2000 : 20000;
  samples.measure(200, count, [&](int i) {
    for (std::size_t t = 0; t < dofs.size(); ++t) dofs[t].depth = pressed[t].depth + 2e-6 * std::sin(0.05 * i + t);
    rig.press(dofs);
    if (i >= 0) held += held_points(rig.haptic(), 0);
  });
  bench::report("held_nodes", "liver1400_64", "held", held / count, "nodes");
  bench::report("held_nodes", "liver1400_64", "p50", 1e6 * samples.median(), "us");
  bench::report("held_nodes", "liver1400_64", "p999", 1e6 * samples.p999(), "us");
}

/// Two probes that lie level on a block, side by side, each with its tip's 44 squares and its shaft's 80 rectangles,
/// and rub along it.
void two_tools(bool quick) {
  using namespace bench;
  const QuasiStaticSpec block = touch_block();
  Scene scene = shaft_scene(block, ContactRule::patch, 0.3);
  scene.tools.resize(2, scene.tools[0]);
  scene.tools[1].name += "1";
  const auto aside = [](int tool) { return (tool == 0 ? -1.5 : 1.5) * kShaftRadius; };
  for (int t = 0; t < 2; ++t) scene.tools[t].pivot.y() = aside(t);
  PressRig rig(scene, {precompute(block, shaft_block_of_edges(2 * kShaftRadius))});
  const auto tips = [&](double along, double depth) {
    std::array<ToolDofs, 2> dofs;
    for (int t = 0; t < 2; ++t)
      dofs[t] = tip_at(rig.scene().tools[t], {2 * kShaftRadius + along, aside(t), kShaftRadius - depth});
    return dofs;
  };
  rig.start(tips(0, -1e-3));
  for (int i = 0; i <= 100; ++i) rig.press(tips(0, -1e-3 + (kShaftRadius / 2 + 1e-3) * i / 100));
  Samples steps;
  steps.measure(200, quick ? 2000 : 20000,
                [&](int i) { rig.press(tips(0.5 * kShaftRadius * std::sin(0.01 * i), kShaftRadius / 2)); });
  report_steps("two_tools_tip_and_shaft", steps);
}

/// A tip on edges of an eighth of its radius, where it rests on more nodes than anywhere: it comes, and slides over
/// others from step to step.
void on_fine_edges(bool quick) {
  using namespace bench;
  const double h = kTipRadius / 8, reach = 1.3 * kTipRadius + 2 * h;
  QuasiStaticSpec block = touch_block();
  block.offline = Offline{};
  block.touchable = NodeSelector{{.indices = {}, .box = Box{{-reach, -reach, -1e-6}, {reach, reach, 1}}, .group = {}}};
  PressRig rig(touch_scene(block, 0.3), {precompute(block, block_of_edges(h))});
  const auto tip = [&](double along, double depth) { return Eigen::Vector3d(along, 0.1 * along, kTipRadius - depth); };
  rig.start(tip(0, -1e-3));
  Samples first, slide;
  const int laps = quick ? 2 : 20;
  for (int lap = 0; lap < laps; ++lap) {
    rig.press(tip(0, -1e-3));
    const auto begin = std::chrono::steady_clock::now();
    rig.press(tip(0, kTipRadius / 2));
    first.add(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    for (int i = 0; i < 1000; ++i) {
      const Eigen::Vector3d at = tip(0.25 * kTipRadius * std::sin(0.02 * i), kTipRadius / 2);
      const auto from = std::chrono::steady_clock::now();
      rig.press(at);
      slide.add(std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count());
    }
  }
  report_steps("fine_edges_first", first);
  report_steps("fine_edges_slide", slide);
}

/// What stands between the device's sample and the tool, and between the tissue's force and the hand, over the scripted
/// motion. The step cannot be run without it, so that it is timed apart, a hundred ticks at a time.
void guards(const Scene& scene, const std::vector<Archive>& archives, bool quick) {
  constexpr int kTogether = 100;
  PressRig rig(scene, archives);
  ScriptedTools tools(scene);
  const Tool& tool = scene.tools[0];
  Port port;
  MotionGuard motion({}, rig.dt());
  PassivityGuard watch(scene.passivity, {&port}, tool.max_force, rig.dt());
  SafetyChain chain(tool.max_force, tool.max_force_rate, rig.dt());
  struct Tick {
    ToolDofs dofs;
    PortMotion motion;
    PortForce asked;
  };
  std::vector<Tick> ticks;
  rig.start(tools.at(0));
  for (double t = 0; t < tools.duration(); t += rig.dt()) {
    const Eigen::Isometry3d before = rig.haptic().pose(0);
    rig.press(tools.at(t));
    ticks.push_back({tools.at(t)[0],
                     motion_between(before, rig.haptic().pose(0), 0),
                     {rig.haptic().force(0), rig.haptic().torque(0), 0}});
  }
  bench::Samples samples;
  std::uint64_t seq = 0;
  samples.measure(20, quick ? 200 : 2000, [&](int i) {
    for (int k = 0; k < kTogether; ++k) {
      const Tick& tick = ticks[((i + 20) * kTogether + k) % ticks.size()];
      bench::keep(motion.follow(tick.dofs, ++seq));
      port.motion = tick.motion;
      watch.observe();
      port.asked = tick.asked;
      chain.limit(port.asked);
      watch.control();
      port.held = port.asked;
      chain.apply(port.held, {port.motion, port.spare});
    }
  });
  bench::report("haptic_step", "guards", "p50", 1e6 * samples.median() / kTogether, "us");
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  const bool quick = palpate::bench::quick(argc, argv);
  const palpate::Scene scene = palpate::load_scene(PALPATE_SCENES "/liver.toml");
  const auto archives = palpate::load_or_precompute(scene, palpate::ArchivePart::surface);
  const auto pushes = palpate::one_contact(scene, archives, "liver1400_contact1", quick);
  palpate::bench::report("publish", "haptic_step", "p50", 1e6 * pushes.median(), "us");
  palpate::bench::report("publish", "haptic_step", "p999", 1e6 * pushes.p999(), "us");
  palpate::guards(scene, archives, quick);
  palpate::one_contact(palpate::relaxing(scene), archives, "liver1400_relaxing", quick);
  palpate::one_contact(palpate::by_nodes(scene), archives, "liver1400_nodes", quick);
  palpate::one_contact(palpate::by_nodes(palpate::relaxing(scene)), archives, "liver1400_nodes_relaxing", quick);
  palpate::two_tools(quick);
  palpate::on_fine_edges(quick);
  palpate::many_contacts(scene, archives, quick);
}
