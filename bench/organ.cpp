// How long does an organ take from its image to a first force, and how do time and memory grow with the image?
// A torus of 32^3 to 512^3 voxels, and the liver of Debian's libcgal-demo, where it or PALPATE_LIVER is there.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <stdexcept>

#include "bench/report.hpp"
#include "common/bus/dds_bus.hpp"
#include "tests/organ/phantom_image.hpp"
#include "tools/shared/child_process.hpp"

namespace {
using namespace palpate;
namespace fs = std::filesystem;

struct Cost {
  double seconds = 0, processor_seconds = 0, megabytes = 0;
};

double seconds_of(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

/// Runs a command line of this project's programs, its output unseen.
Cost cost_of(const std::string& command) {
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", fmt::format("exec {}/{} >/dev/null 2>&1", PALPATE_BIN, command).c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  rusage used{};
  if (child < 0 || wait4(child, &status, 0, &used) != child || status != 0)
    throw std::runtime_error(command + ": it failed");
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  return {wall.count(), seconds_of(used.ru_utime) + seconds_of(used.ru_stime),
          1e-3 * static_cast<double>(used.ru_maxrss)};
}

rusage used_by_children() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  return used;
}

/// Runs a scene until its probe feels a force, with the precomputation and the way there.
Cost cost_to_first_force(const std::string& scene) {
  constexpr int kDomain = 98;
  const auto start = std::chrono::steady_clock::now();
  const rusage before = used_by_children();
  const auto bus = make_dds_bus({.domain = kDomain});
  const auto forces = bus->reader(topics::force_state);
  std::chrono::duration<double> wall{0};
  {
    ChildProcess run("palpate", {PALPATE_BIN "/palpate", "run", scene, "--domain", std::to_string(kDomain)});
    while (wall.count() == 0) {
      if (!run.running()) throw std::runtime_error(scene + ": it ended without a force");
      bus->wait(std::chrono::milliseconds(5));
      while (const auto force = forces->take())
        if (wall.count() == 0 && std::ranges::any_of(force->force, [](double f) { return f != 0; }))
          wall = std::chrono::steady_clock::now() - start;
    }
  }
  const rusage after = used_by_children();
  return {wall.count(), seconds_of(after.ru_utime) + seconds_of(after.ru_stime) - seconds_of(before.ru_utime) -
                            seconds_of(before.ru_stime)};
}

void report_torus(const fs::path& folder, int size) {
  const std::string image = folder / "torus.inr";
  const double middle = 0.5 * size - 0.4;
  testing::write_phantom(image, {size, size, size}, 128.0 / size, [&](int i, int j, int k) {
    return std::hypot(std::hypot(i - middle, j - middle) - 0.28 * size, k - middle) < 0.12 * size;
  });
  const Cost cost = cost_of(
      fmt::format("palpate_organ organ {} --label 1 --edge 0.006 -o {}", image, (folder / "torus.msh").string()));
  const std::string name = fmt::format("torus_{}", size);
  bench::report("organ", name, "seconds", cost.seconds, "s");
  bench::report("organ", name, "memory", cost.megabytes, "MB");
}

/// The image of the liver; empty: it is not there.
std::string liver_in(const fs::path& folder) {
  constexpr const char* kArchive = "/usr/share/doc/libcgal-dev/data.tar.gz";
  if (const char* const named = std::getenv("PALPATE_LIVER")) return named;
  if (!fs::exists(kArchive)) return "";
  const std::string extract = fmt::format("tar -xzf {} -C {} data/images/liver.inr.gz", kArchive, folder.string());
  return std::system(extract.c_str()) == 0 ? folder / "data/images/liver.inr.gz" : "";
}

/// Three commands: organ, scene, and run up to its first force.
void report_liver(const fs::path& folder) {
  const std::string image = liver_in(folder), mesh = folder / "organ.msh", scene = folder / "organ.toml";
  if (image.empty()) {
    fmt::print(stderr, "bench_organ: no liver: Debian's libcgal-demo has one, or PALPATE_LIVER names it\n");
    return;
  }
  const Cost organ = cost_of(
      fmt::format("palpate_organ organ {} --label 255=liver --label 85=gall_bladder --group attachment=above:z -o {}",
                  image, mesh));
  const Cost made = cost_of(fmt::format("palpate scene {} --tissue liver -o {}", mesh, scene));
  const Cost felt = cost_to_first_force(scene);
  bench::report("organ", "liver_volume", "seconds", organ.seconds + made.seconds + felt.seconds, "s");
  bench::report("organ", "liver_volume", "run_seconds", felt.seconds, "s");
  bench::report("organ", "liver_volume", "processor_seconds",
                organ.processor_seconds + made.processor_seconds + felt.processor_seconds, "s");
  bench::report("organ", "liver_volume", "memory", organ.megabytes, "MB");
}

void run(bool quick) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("palpate-bench-organ-{}", getpid());
  fs::create_directories(folder);
  setenv("XDG_CACHE_HOME", folder.c_str(), 1);  // archives are made anew
  for (const int size : {32, 64, 128, 256, 512})
    if (!quick || size <= 128) report_torus(folder, size);
  report_liver(folder);
  fs::remove_all(folder);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(palpate::bench::quick(argc, argv));
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_organ: {}\n", error.what());
    return 1;
  }
}
