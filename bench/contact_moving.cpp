// What does a tick of moving tissue take while tools touch, hold and cut it? The tissue of a whole scene in lock step
// with its scripted tools, on one core, by the world that the deformation node owns; ticks with a contact count.
#include <exception>

#include "bench/report.hpp"
#include "common/scene/ensure_archive.hpp"
#include "tools/rig/press_rig.hpp"
#include "tools/rig/scripted_tools.hpp"

namespace {
using namespace palpate;

void report_scene(const char* name, double seconds) {
  const Scene scene = load_scene(fmt::format("{}/{}.toml", PALPATE_SCENES, name));
  PressRig rig(scene, load_or_precompute(scene, ArchivePart::surface));
  ScriptedTools tools(scene);
  bench::Samples touched;
  const double end = std::min(seconds, tools.duration());
  for (int i = 0; i * rig.dt() < end; ++i) {
    const auto dofs = tools.at(i * rig.dt());
    bench::Samples one;
    one.measure(0, 1, [&](int) { rig.press(dofs); });
    if (!rig.organ().contacts().empty()) touched.add(one.max());
  }
  const auto in_us = [&](const char* metric, double value) {
    bench::report("contact_moving", name, metric, 1e6 * value, "us");
  };
  in_us("p50", touched.median());
  in_us("p99", touched.p99());
  bench::report("contact_moving", name, "ticks", static_cast<double>(touched.size()), "1");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    report_scene("hepatectomy", palpate::bench::quick(argc, argv) ? 3 : 15);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_contact_moving: {}\n", error.what());
    return 1;
  }
}
