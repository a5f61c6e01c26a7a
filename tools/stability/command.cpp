#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "common/cli/command_line.hpp"
#include "common/scene/scene_changes.hpp"
#include "tools/shared/jobs_option.hpp"
#include "tools/shared/set_option.hpp"
#include "tools/stability/subject.hpp"
#include "tools/stability/table.hpp"
#include "tools/study/commands.hpp"
#include "tools/study/run_script.hpp"

namespace palpate {
namespace {

struct StabilityOptions {
  std::string scene, folder;
  std::vector<std::string> set;
  stability::TableRun run;
  bool quick = false, json = false;
};

void print_json(const stability::Row& row) {
  const nlohmann::ordered_json line{
      {"case", row.name},       {"parameter", row.parameter}, {"value", row.value},
      {"outcome", row.outcome}, {"max_force", row.max_force}, {"energy_growth", row.energy_growth},
      {"note", row.note}};
  fmt::print("{}\n", line.dump());
}

void run(const StabilityOptions& o) {
  std::optional<Scene> scene;
  if (!o.scene.empty()) scene = load_scene(o.scene, parse_changes(o.set));
  const stability::Extent extent{.quick = o.quick};
  const auto points = scene ? stability::scene_points(*scene, extent) : stability::all_points(extent);
  const int failed =
      stability::run_table(points, o.folder, stability::subject_of(scene ? &*scene : nullptr, o.quick), o.run);
  const std::string missing = run_script("stability_page.py", o.folder);
  if (o.json)
    for (const stability::Row& row : stability::read_rows(std::filesystem::path(o.folder) / "stability.csv"))
      if (row.name.find(o.run.only) != std::string::npos) print_json(row);
  if (!missing.empty())
    fmt::print(stderr, "stability: {}\n", missing);
  else if (!o.json)
    fmt::print("{}\n", (std::filesystem::path(o.folder) / "index.html").string());
  if (failed > 0)
    throw std::runtime_error(fmt::format("{} points failed{}; see {}/stability.csv", failed,
                                         o.run.known.empty() ? "" : " that are not known to", o.folder));
}

}  // namespace

void add_stability_command(cli::Command& app) {
  auto options = std::make_shared<StabilityOptions>();
  cli::Command command =
      app.add_command("stability", "Stiff and extreme cases, each with its outcome, as a table and a page");
  const cli::Option scene = command.add_option("SCENE", options->scene, "Scene file; without one, the general cases");
  add_set_option(command, options->set).needs(scene);
  command.add_option("-o,--output", options->folder, "Folder for stability.csv, plots and page").required();
  command.add_flag("--quick", options->quick, "A subset that takes some minutes");
  command.add_option("--only", options->run.only, "Cases whose name contains this");
  command.add_option("--known", options->run.known,
                     "List of points that are known to fail, `case | parameter | value | why` a line: an error is what "
                     "fails beside them");
  command.add_flag("--json", options->json, "Print one line of JSON a case");
  add_jobs_option(command, options->run.jobs, "Cases");
  command.tells_progress();
  command.examples({"palpate stability --quick -o out/stability",
                    "palpate stability scenes/plate.toml --set contact.friction=0.5 --jobs 1 -o out/plate"});
  command.does([options] { run(*options); });
}

}  // namespace palpate
