// Runs a scene with its scripted motions through the simulator and prints, for every second, a hash of each thing that
// the simulation gives: two builds that agree print the same. The largest force of each second tells that something
// happened.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "common/describe/hash64.hpp"
#include "common/devices/device.hpp"
#include "common/kernels/code_path.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/sim/simulator.hpp"

namespace palpate::sim {
namespace {

constexpr std::uint64_t kSurfaceInterval = 16;  // steps: the visual rate, about

/// One column each.
struct Hashes {
  Hash64 force, torque, trocar, grip, opening, flags, energy, contacts, tissue, modes, particles, surfaces;

  auto named() const {
    return std::array{
        std::pair{"force", &force},   std::pair{"torque", &torque},       std::pair{"trocar", &trocar},
        std::pair{"grip", &grip},     std::pair{"opening", &opening},     std::pair{"flags", &flags},
        std::pair{"energy", &energy}, std::pair{"contacts", &contacts},   std::pair{"tissue", &tissue},
        std::pair{"modes", &modes},   std::pair{"particles", &particles}, std::pair{"surfaces", &surfaces}};
  }
};

/// What happened, for people.
struct Course {
  double max_force = 0, max_grip = 0;  ///< [N], [N m]
  std::size_t removed = 0;             ///< tetrahedra
};

void add_tools(const Simulator& simulator, Hashes& h, Course& course) {
  for (int t = 0; t < simulator.tools(); ++t) {
    const ToolView tool = simulator.tool(t);
    h.force.add(tool.force);
    h.torque.add(tool.torque);
    h.trocar.add(tool.trocar_force);
    h.grip.add(tool.grip_torque);
    h.opening.add(tool.opening);
    h.flags.add(tool.flags);
    for (const HeldContact& c : simulator.contacts(t).contacts) {
      h.contacts.add(c.body);
      h.contacts.add(std::span<const std::uint32_t>(c.nodes));
      h.contacts.add(std::span<const double>(c.force));
      h.contacts.add(c.sticking);
    }
    course.max_force = std::max(course.max_force, tool.force.norm());
    course.max_grip = std::max(course.max_grip, std::abs(tool.grip_torque));
  }
}

void add_bodies(Simulator& simulator, Hashes& h, Course& course) {
  h.energy.add(simulator.energy());
  h.tissue.add(simulator.tissue().hash());
  const HapticStep& haptic = simulator.haptic();
  for (const HapticStep::Entry& entry : haptic.entries())
    (entry.part->wall() ? h.modes : h.particles).add(entry.part->coordinates());
  for (const ChangeView& change : simulator.changes()) course.removed += change.removed.size();
  if (simulator.steps() % kSurfaceInterval != 0) return;
  for (int b = 0; b < simulator.bodies(); ++b) {
    const SurfaceView surface = simulator.surface(b);
    h.surfaces.add(surface.position);
    h.surfaces.add(surface.normal);
  }
}

void print_second(int second, const Hashes& h, const Course& course) {
  fmt::print("{:3}", second);
  for (const auto& [name, digest] : h.named()) fmt::print(" {} {:016x}", name, digest->value());
  fmt::print(" max_force {:a} ({:.4f} N) max_grip {:.5f} Nm removed {}\n", course.max_force, course.max_force,
             course.max_grip, course.removed);
}

void run(const std::string& file, double seconds) {
  const Scene scene = load_scene(file);
  Simulator simulator(scene, load_or_precompute(scene, ArchivePart::surface));
  const auto devices = make_devices(scene.tools, scene.rates.haptic_hz);
  std::vector<ToolInput> inputs(devices.size());
  const auto read = [&](double time) {
    std::ranges::transform(devices, inputs.begin(), [&](const auto& device) { return device->read(time); });
  };
  const auto over = [&](double time) {
    const bool moved = std::ranges::all_of(devices, [&](const auto& device) { return device->finished(time); });
    return moved || (seconds > 0 && time >= seconds);
  };
  fmt::print("{}; code path {}\n", scene.title, code_path());
  read(0);
  simulator.start(inputs);
  const auto per_second = static_cast<std::uint64_t>(std::lround(1 / simulator.dt()));
  for (std::uint64_t step = 0; !over(static_cast<double>(step) * simulator.dt());) {
    Hashes hashes;
    Course course;
    do {
      read(static_cast<double>(step) * simulator.dt());
      simulator.step(inputs);
      add_tools(simulator, hashes, course);
      add_bodies(simulator, hashes, course);
      ++step;
    } while (step % per_second != 0 && !over(static_cast<double>(step) * simulator.dt()));
    print_second(static_cast<int>((step - 1) / per_second), hashes, course);
  }
}

}  // namespace
}  // namespace palpate::sim

int main(int argc, char** argv) {
  CLI::App app{"scene_hashes: one line of hashes for each second of a scene's scripted motion"};
  std::string scene;
  double seconds = 0;
  app.add_option("scene", scene, "Scene file")->required();
  app.add_option("--seconds", seconds, "Stop after so many seconds")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    palpate::sim::run(scene, seconds);
  } catch (const std::exception& error) {
    fmt::print(stderr, "scene_hashes: {}\n", error.what());
    return 1;
  }
}
