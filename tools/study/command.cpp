#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/cli/progress.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/scene/scene_changes.hpp"
#include "tools/shared/child_process.hpp"
#include "tools/shared/set_option.hpp"
#include "tools/shared/shell_line.hpp"
#include "tools/study/commands.hpp"
#include "tools/study/growth.hpp"
#include "tools/study/run_script.hpp"
#include "tools/study/study.hpp"

namespace palpate {
namespace {

struct Arguments {
  std::vector<std::string> scenes, set;
  std::string out, budget, references;
  int jobs = 1, setting = -1;
  bool quick = false, growth = false, json = false, tasks = false;
};

/// "1ms", "250us", "0.5 ms" or "0.001s".
double seconds_of(const std::string& text) {
  std::size_t end = 0;
  double value = 0;
  try {
    value = std::stod(text, &end);
  } catch (const std::exception&) {
    end = 0;
  }
  std::string unit = end == 0 ? "?" : text.substr(end);
  std::erase(unit, ' ');
  const double scale = unit == "us" ? 1e-6 : unit == "ms" ? 1e-3 : unit == "s" ? 1 : 0;
  if (!(value * scale > 0))
    throw std::runtime_error(fmt::format("--budget {}: not a time with its unit, such as 1ms or 250us", text));
  return value * scale;
}

void tell(const std::string& line) {
  cli::say(line);
}

/// `to`: where its place is told.
void make_page(const std::filesystem::path& folder, std::FILE* to) {
  const std::string missing = run_script("study_page.py", folder);
  fmt::print(to, "{}\n", missing.empty() ? (folder / "index.html").string() : missing);
}

/// By the names of study.csv; what is not known is null.
void print_json(const study::Row& row) {
  const nlohmann::ordered_json line{{"scene", row.scene},
                                    {"method", row.method},
                                    {"knob", row.knob},
                                    {"value", row.value},
                                    {"step_us_median", row.step_us_median},
                                    {"step_us_p99", row.step_us_p99},
                                    {"offline_s", row.offline_s},
                                    {"memory_bytes", row.memory_bytes},
                                    {"err_u_rel", row.err_u_rel},
                                    {"err_f_rel", row.err_f_rel},
                                    {"reference", row.reference}};
  fmt::print("{}\n", line.dump());
}

/// All of them before the first is studied. Throws std::runtime_error where two would share a folder.
std::vector<Scene> load_scenes(const std::vector<std::string>& files, const std::vector<SceneChange>& changes) {
  std::vector<Scene> scenes;
  for (const std::string& file : files) {
    scenes.push_back(load_scene(file, changes));
    for (std::size_t i = 0; i + 1 < scenes.size(); ++i)
      if (scenes[i].file.stem() == scenes.back().file.stem())
        throw std::runtime_error(fmt::format("study: two scenes are called {}", scenes.back().file.stem().string()));
  }
  return scenes;
}

/// The command that settles one setting of a scene alone.
std::vector<std::string> setting_alone(const Arguments& arguments, const Scene& scene,
                                       const std::filesystem::path& folder, const std::filesystem::path& references,
                                       std::size_t setting) {
  std::vector<std::string> words{sibling_program("palpate"), "study", std::filesystem::absolute(scene.file).string()};
  for (const std::string& change : arguments.set) words.insert(words.end(), {"--set", change});
  words.insert(words.end(), {"--output", std::filesystem::absolute(folder).string(), "--setting",
                             std::to_string(setting), "--jobs", std::to_string(arguments.jobs)});
  if (!references.empty()) words.insert(words.end(), {"--references", std::filesystem::absolute(references).string()});
  if (arguments.quick) words.emplace_back("--quick");
  return words;
}

void run(const Arguments& arguments) {
  catch_shutdown_signals();
  study::StudyOptions options{
      .quick = arguments.quick, .references = arguments.references, .budget_text = arguments.budget, .say = tell};
  options.jobs = arguments.jobs;
  if (!arguments.budget.empty()) options.budget = seconds_of(arguments.budget);
  const std::filesystem::path out = arguments.out;
  const bool several = arguments.scenes.size() > 1 || arguments.growth;  // a folder each, and an index
  if (arguments.scenes.empty() && !arguments.growth)
    throw std::runtime_error("study: name a scene, or ask for --growth");
  if (several && arguments.setting >= 0) throw std::runtime_error("study: --setting is of one scene");
  std::FILE* const to = arguments.json ? stderr : stdout;
  if (several && options.references.empty()) options.references = out / "references";
  if (arguments.jobs > 1) setenv("OMP_NUM_THREADS", "1", 0);  // each setting keeps to one core
  for (const Scene& scene : load_scenes(arguments.scenes, parse_changes(arguments.set))) {
    const auto folder = several ? out / scene.file.stem() : out;
    options.setting_alone = [&](std::size_t setting) {
      return setting_alone(arguments, scene, folder, options.references, setting);
    };
    if (arguments.tasks) {
      for (std::size_t i = 0, count = count_settings(scene, options); i < count; ++i)
        fmt::print("{}\n", shell_line(options.setting_alone(i)));
      continue;
    }
    if (arguments.setting >= 0) return run_setting(scene, folder, options, static_cast<std::size_t>(arguments.setting));
    const study::Result result = study::run_study(scene, folder, options);
    if (arguments.json)
      for (const study::Row& row : result.rows) print_json(row);
    make_page(folder, to);
  }
  if (arguments.tasks) return;
  if (arguments.growth) study::measure_growth(out, arguments.quick, tell);
  if (several) make_page(out, to);
}

}  // namespace

void add_study_command(cli::Command& app) {
  cli::Command command = app.add_command("study", "Error against run time of all that can serve a scene");
  auto arguments = std::make_shared<Arguments>();
  command.add_option("SCENE", arguments->scenes, "Scene files (TOML)");
  add_set_option(command, arguments->set);
  command
      .add_option("-o,--output", arguments->out,
                  "Folder for figures and page; with several scenes one folder each in it")
      .required();
  command.add_option("--budget", arguments->budget,
                     "Names the most accurate configuration whose step takes no longer, such as 1ms, and "
                     "writes it as a scene");
  command.add_flag("--growth", arguments->growth,
                   "How a step's time grows over surface nodes, contacts, edges, modes and particles");
  command.add_flag("--json", arguments->json, "Print one line of JSON a setting");
  command.add_flag("--quick", arguments->quick, "Fewer patches, samples and knobs");
  command
      .add_option(
          "--jobs", arguments->jobs,
          "Settings at the same time, each in a process of its own; their steps are timed beside one another then")
      .between(1, 1024)
      .show_default();
  command.add_flag("--tasks", arguments->tasks,
                   "Print the command of each setting, one a line; what they leave in the folder is what a run without "
                   "this option goes on with");
  command
      .add_option("--setting", arguments->setting, "Settle this setting of the scene alone, from 0, as --tasks has it")
      .between(0, 1'000'000);
  command.add_option("--references", arguments->references,
                     "Folder where references are kept, instead of the output's");
  command.tells_progress();
  command.examples({"palpate study scenes/plate.toml --quick -o out/study",
                    "palpate study scenes/liver.toml --budget 200us -o out/liver",
                    "palpate study scenes/liver.toml --tasks -o out/liver > tasks.sh"});
  command.does([arguments] { run(*arguments); });
}

}  // namespace palpate
