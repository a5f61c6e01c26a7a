#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "common/cli/command_line.hpp"
#include "common/scene/scene_changes.hpp"
#include "tools/shared/child_process.hpp"
#include "tools/shared/jobs_option.hpp"
#include "tools/shared/set_option.hpp"
#include "tools/shared/shell_line.hpp"
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
  int point = -1;  ///< >= 0: that one of the points alone
  bool quick = false, json = false, tasks = false;
};

/// The command that runs one point alone.
std::vector<std::string> point_alone(const StabilityOptions& o, std::size_t point) {
  std::vector<std::string> words{sibling_program("palpate"), "stability"};
  if (!o.scene.empty()) words.push_back(std::filesystem::absolute(o.scene).string());
  for (const std::string& change : o.set) words.insert(words.end(), {"--set", change});
  words.insert(words.end(),
               {"--output", std::filesystem::absolute(o.folder).string(), "--point", std::to_string(point)});
  if (o.quick) words.emplace_back("--quick");
  return words;
}

void print_json(const stability::Row& row) {
  const nlohmann::ordered_json line{
      {"case", row.name},       {"parameter", row.parameter}, {"value", row.value},
      {"outcome", row.outcome}, {"max_force", row.max_force}, {"energy_growth", row.energy_growth},
      {"note", row.note}};
  fmt::print("{}\n", line.dump());
}

/// What it comes to stands in its row.
void run_point(const std::vector<stability::Point>& points, const StabilityOptions& o, const std::string& subject) {
  const auto point = static_cast<std::size_t>(o.point);
  stability::run_table(points, stability::folder_of_point(o.folder, point), subject, {.point = point});
}

void run(const StabilityOptions& o) {
  std::optional<Scene> scene;
  if (!o.scene.empty()) scene = load_scene(o.scene, parse_changes(o.set));
  const stability::Extent extent{.quick = o.quick};
  const auto points = scene ? stability::scene_points(*scene, extent) : stability::all_points(extent);
  if (o.tasks) {
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i].name.find(o.run.only) != std::string::npos) fmt::print("{}\n", shell_line(point_alone(o, i)));
    return;
  }
  const std::string subject = stability::subject_of(scene ? &*scene : nullptr, o.quick);
  if (o.point >= 0) return run_point(points, o, subject);
  const int failed = stability::run_table(points, o.folder, subject, o.run);
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
  command.add_flag("--tasks", options->tasks,
                   "Print the command of each point, one a line; what they leave in the folder is what a run without "
                   "this option goes on with");
  command.add_option("--point", options->point, "Run this point alone, from 0, as --tasks has it")
      .between(0, 1'000'000);
  command.tells_progress();
  command.examples({"palpate stability --quick -o out/stability",
                    "palpate stability scenes/plate.toml --set contact.friction=0.5 --jobs 1 -o out/plate",
                    "palpate stability --tasks -o out/stability > tasks.sh"});
  command.does([options] { run(*options); });
}

}  // namespace palpate
