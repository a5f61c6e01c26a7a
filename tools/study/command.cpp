#include <fmt/format.h>

#include <memory>
#include <stdexcept>

#include "common/cli/progress.hpp"
#include "common/scene/scene_changes.hpp"
#include "tools/set_option.hpp"
#include "tools/study/commands.hpp"
#include "tools/study/growth.hpp"
#include "tools/study/run_script.hpp"
#include "tools/study/study.hpp"

namespace palpate {
namespace {

struct Arguments {
  std::vector<std::string> scenes, set;
  std::string out, budget;
  bool quick = false, growth = false;
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

void make_page(const std::filesystem::path& folder) {
  const std::string missing = run_script("study_page.py", folder);
  fmt::print("{}\n", missing.empty() ? (folder / "index.html").string() : missing);
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

void run(const Arguments& arguments) {
  study::StudyOptions options{.quick = arguments.quick, .budget_text = arguments.budget, .say = tell};
  if (!arguments.budget.empty()) options.budget = seconds_of(arguments.budget);
  const std::filesystem::path out = arguments.out;
  const bool several = arguments.scenes.size() > 1 || arguments.growth;  // a folder each, and an index
  if (arguments.scenes.empty() && !arguments.growth)
    throw std::runtime_error("study: name a scene, or ask for --growth");
  if (several) options.references = out / "references";
  for (const Scene& scene : load_scenes(arguments.scenes, parse_changes(arguments.set))) {
    const auto folder = several ? out / scene.file.stem() : out;
    study::run_study(scene, folder, options);
    make_page(folder);
  }
  if (arguments.growth) study::measure_growth(out, arguments.quick, tell);
  if (several) make_page(out);
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
  command.add_flag("--quick", arguments->quick, "Fewer patches, samples and knobs");
  command.tells_progress();
  command.examples({"palpate study scenes/plate.toml --quick -o out/study",
                    "palpate study scenes/liver.toml --budget 200us -o out/liver"});
  command.does([arguments] { run(*arguments); });
}

}  // namespace palpate
