#include "tools/study/study.hpp"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <stdexcept>

#include "common/realtime/shutdown.hpp"
#include "tools/study/budget.hpp"
#include "tools/study/kinds.hpp"
#include "tools/study/machine.hpp"
#include "tools/study/measure.hpp"
#include "tools/study/output_folder.hpp"
#include "tools/study/store.hpp"

namespace palpate::study {
namespace {

/// A refused point is a row without figures, and its reason.
Result refused(const Scene& scene, const Point& point, const std::string& why) {
  const std::string name = scene.file.stem().string();
  Result result;
  result.rows.push_back({name, point.method, point.knob, point.value});
  result.notes.push_back({name, point.method, point.knob, point.value, "refused: " + why});
  return result;
}

Result evaluate(const Scene& scene, Method& method, const Point& point) {
  try {
    return method.evaluate(point);
  } catch (const std::runtime_error& error) {
    return refused(scene, point, error.what());
  }
}

void spend(const Scene& scene, const Methods& methods, const Result& result, const std::filesystem::path& folder,
           const StudyOptions& options) {
  const auto choice = choose(methods, scene, result, *options.budget);
  std::string text = fmt::format("No configuration fits a step within {} here.", options.budget_text);
  if (choice) {
    std::string unit = options.budget_text;
    std::erase(unit, ' ');
    const auto file = folder / fmt::format("{}_within_{}.toml", scene.file.stem().string(), unit);
    write_choice(scene, *choice, file);
    std::string settings;
    for (const Point& p : choice->points)
      settings += fmt::format("{}{}, {} = {}", settings.empty() ? "" : "; ", p.method, p.knob, p.value);
    const char* judged = is_quiet(result) ? "judged by both, the machine being quiet"
                                          : "judged by the median alone, the machine not being quiet";
    text = fmt::format(
        "Within {}: {}; step {:.3g} us, 99th percentile {:.3g} us, {}; largest error {:.2g} %; written as {}.",
        options.budget_text, settings, 1e6 * choice->median, 1e6 * choice->p99, judged, 100 * choice->error,
        file.filename().string());
  }
  std::ofstream(folder / "budget.txt") << text << '\n';
  options.say(text);
}

}  // namespace

Methods make_methods(const Scene& scene, const StudyOptions& options) {
  Methods methods;
  for (int b = 0; b < static_cast<int>(scene.bodies.size()); ++b) {
    const StudiedBody body{scene, b, options};
    for (auto& m : std::visit([&](const auto& spec) { return methods_of(spec, body); }, scene.bodies[b]))
      methods.push_back(std::move(m));
  }
  return methods;
}

Result run_study(const Scene& scene, const std::filesystem::path& folder, const StudyOptions& options) {
  prepare_folder(folder, {"study.csv", fmt::format("{}\n", kStudyHead)}, {"index.html"});
  const Store store(folder, study_key(scene, options.quick));
  if (store.is_new()) std::filesystem::remove(folder / "machine.txt");
  StudyOptions here = options;
  if (here.references.empty()) here.references = folder / "references";
  const Methods methods = make_methods(scene, here);
  std::vector<std::pair<Method*, Point>> all;
  for (const auto& method : methods)
    for (const Point& point : method->points()) all.emplace_back(method.get(), point);
  Result result;
  bool described = false;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (shutdown_requested())
      throw Interrupted(
          fmt::format("stopped after {} of {} points, which stay in {}: the same command goes on from there", i,
                      all.size(), folder.string()));
    const auto& [method, point] = all[i];
    const auto begin = std::chrono::steady_clock::now();
    const auto found = store.find(point);
    if (!found && !described) describe_machine(folder), described = true;
    const Result one = found ? *found : evaluate(scene, *method, point);
    if (!found) store.keep(point, one);
    append(result, one);
    write_result(result, folder);
    options.say(fmt::format("{} {}/{}: {}, {} = {}: {}", scene.file.stem().string(), i + 1, all.size(), point.method,
                            point.knob, point.value, found ? "kept" : fmt::format("{:.1f} s", seconds_since(begin))));
  }
  std::filesystem::remove(folder / "budget.txt");
  if (options.budget) spend(scene, methods, result, folder, options);
  return result;
}

}  // namespace palpate::study
