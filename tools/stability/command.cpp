#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "common/tensors/ensure_archive.hpp"
#include "tools/commands.hpp"
#include "tools/stability/table.hpp"

namespace palpate {
namespace {

struct Options {
  std::string scene, folder, only;
  bool quick = false;
};

void run(const Options& o) {
  std::vector<stability::Point> points;
  std::string subject = "the general cases";
  if (o.scene.empty()) {
    points = stability::all_points({.quick = o.quick});
  } else {
    const Scene scene = load_scene(o.scene);
    subject = scene_hash(scene);
    points = stability::scene_points(scene, {.quick = o.quick});
  }
  std::erase_if(points, [&](const stability::Point& p) { return p.name.find(o.only) == std::string::npos; });
  const int failed = stability::run_table(points, o.folder, fmt::format("{} of {}", subject, PALPATE_VERSION));
  const std::string script = PALPATE_SOURCE_DIR "/scripts/stability_page.py";
  const std::string arguments = fmt::format("'{}' '{}'", script, o.folder);
  const auto paged = [&](const char* python) { return std::system(fmt::format("{} {} 2>/dev/null", python, arguments).c_str()) == 0; };
  if (!paged("python3") && !paged("/usr/bin/python3"))
    fmt::print(stderr, "stability: no page was made (python3 with matplotlib is missing); the table is in {}/stability.csv\n", o.folder);
  if (failed > 0) throw std::runtime_error(fmt::format("{} of {} points failed; see {}/stability.csv", failed, points.size(), o.folder));
}

}  // namespace

void add_stability_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("stability", "stiff and extreme cases, each with its outcome, as a table and a page");
  command->add_option("scene", options->scene, "scene file; without one, the general cases");
  command->add_option("-o,--output", options->folder, "folder for stability.csv, plots and page")->required();
  command->add_flag("--quick", options->quick, "the subset that takes a minute");
  command->add_option("--only", options->only, "cases whose name contains this");
  command->callback([options] { run(*options); });
}

}  // namespace palpate
