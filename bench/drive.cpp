// How many times faster than real time does a whole scene run in lock step, on one core? From the first step to the
// last: forces, tissue and shapes at 20 Hz; the archives are there.
#include <exception>

#include "bench/report.hpp"
#include "common/scene/scene.hpp"
#include "tools/drive/run.hpp"

namespace {
using namespace palpate;

double factor_of(const std::string& scene, double seconds) {
  const drive::PointResult result =
      drive::run_scene(load_scene(fmt::format("{}/{}.toml", PALPATE_SCENES, scene)), {.seconds = seconds});
  return drive::find(result.figures, "realtime_factor")->value;
}

/// The median of a few runs.
void report_scene(const std::string& scene, int runs, double seconds) {
  bench::Samples factors;
  for (int i = 0; i < runs; ++i) factors.add(factor_of(scene, seconds));
  bench::report("drive", scene, "realtime_factor", factors.median(), "1");
}

void run(bool quick) {
  report_scene("liver", quick ? 3 : 9, 0);
  report_scene("hepatectomy", quick ? 1 : 3, 0);
  report_scene("plate_cut", quick ? 1 : 3, 0);
  report_scene("catheter_insertion", quick ? 1 : 3, 0);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(palpate::bench::quick(argc, argv));
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_drive: {}\n", error.what());
    return 1;
  }
}
