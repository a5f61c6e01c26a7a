// How long from the reading of the tool to the deformed surface in another process's hands? haptic_node and
// deform_node run on the liver scene over loopback; this program is the third process and receives the surface. The
// same sizes over bare Cyclone DDS stand in the rows of bench_latency_dds.
#include "bench/report.hpp"
#include "common/bus/dds_bus.hpp"
#include "common/realtime/clock.hpp"
#include "common/scene/ensure_archive.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

void measure(double seconds) {
  const std::string scene = PALPATE_SCENES "/liver.toml", domain = "99";
  for (const Body& body : load_scene(scene).bodies) ensure_archive(load_scene(scene), body);
  const auto bus = make_dds_bus({.domain = 99});
  const auto surfaces = bus->reader(topics::surface_state);
  ChildProcess deform("deform_node", {sibling_program("deform_node"), scene, "--domain", domain});
  ChildProcess haptic("haptic_node", {sibling_program("haptic_node"), scene, "--domain", domain, "--seconds",
                                      fmt::format("{}", seconds)});
  bench::Samples latency;
  std::uint64_t last_step = 0;
  while (haptic.running()) {
    bus->wait(std::chrono::milliseconds(5));
    while (const auto surface = surfaces->take()) {
      if (surface->run != 0 && surface->step > last_step)
        latency.add(1e-9 * static_cast<double>(now_ns() - surface->sense_ns));
      last_step = surface->step;
    }
  }
  bench::report("latency", "loopback_tool_to_surface", "samples", static_cast<double>(latency.size()), "1");
  bench::report("latency", "loopback_tool_to_surface", "p50", 1e6 * latency.median(), "us");
  bench::report("latency", "loopback_tool_to_surface", "p99", 1e6 * latency.p99(), "us");
  bench::report("latency", "loopback_tool_to_surface", "p999", 1e6 * latency.p999(), "us");
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::measure(palpate::bench::quick(argc, argv) ? 5 : 10);
}
