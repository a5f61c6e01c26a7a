#include "tools/study/study.hpp"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <stdexcept>

#include "common/realtime/shutdown.hpp"
#include "tools/shared/run_children.hpp"
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

/// All settings of a scene's methods, and what is kept of them in the study's folder.
class Sweep {
 public:
  Sweep(const Scene& scene, const std::filesystem::path& folder, const StudyOptions& options)
      : scene_(scene), folder_(folder), options_(options), store_(prepared(folder), study_key(scene, options.quick)) {
    if (store_.is_new()) std::filesystem::remove(folder / "machine.txt");
    if (options_.references.empty()) options_.references = folder / "references";
    methods_ = make_methods(scene, options_);
    for (const auto& method : methods_)
      for (const Point& point : method->points()) settings_.emplace_back(method.get(), point);
  }

  std::size_t size() const { return settings_.size(); }
  const Methods& methods() const { return methods_; }

  /// What is kept of a setting, or else what comes of it, which is kept.
  Result settle(std::size_t i) const {
    const auto& [method, point] = settings_[i];
    const auto begin = std::chrono::steady_clock::now();
    if (const auto found = store_.find(point)) {
      say(i, "kept");
      return *found;
    }
    describe_machine(folder_, options_.jobs);
    Result result = evaluate(scene_, *method, point);
    store_.keep(point, result);
    say(i, fmt::format("{:.1f} s", seconds_since(begin)));
    return result;
  }

  /// What is not kept yet, each setting in a process of its own.
  void settle_beside_one_another() const {
    std::vector<std::size_t> missing;
    std::vector<std::vector<std::string>> commands;
    for (std::size_t i = 0; i < size(); ++i)
      if (!store_.find(settings_[i].second)) {
        missing.push_back(i);
        commands.push_back(options_.setting_alone(i));
      }
    std::size_t done = 0;
    run_children("study", commands, options_.jobs,
                 {.printed = [](std::size_t, const std::string&) {},
                  .ended =
                      [&](std::size_t c, int status) {
                        ++done;
                        if (status != 0)  // it is computed here then
                          say(missing[c], fmt::format("its process ended with status {}", status));
                      }});
    if (shutdown_requested()) stop(size() - missing.size() + done);
  }

  /// Throws Interrupted, with where what is done is kept.
  [[noreturn]] void stop(std::size_t settled) const {
    throw Interrupted(
        fmt::format("stopped after {} of {} settings, which stay in {}: the same command goes on from there", settled,
                    size(), folder_.string()));
  }

 private:
  static const std::filesystem::path& prepared(const std::filesystem::path& folder) {
    prepare_folder(folder, {"study.csv", fmt::format("{}\n", kStudyHead)}, {"index.html"});
    return folder;
  }

  void say(std::size_t i, const std::string& what) const {
    const Point& point = settings_[i].second;
    options_.say(fmt::format("{} {}/{}: {}, {} = {}: {}", scene_.file.stem().string(), i + 1, size(), point.method,
                             point.knob, point.value, what));
  }

  const Scene& scene_;
  std::filesystem::path folder_;
  StudyOptions options_;
  Store store_;
  Methods methods_;
  std::vector<std::pair<Method*, Point>> settings_;
};

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
  const Sweep sweep(scene, folder, options);
  if (options.jobs > 1) sweep.settle_beside_one_another();
  Result result;
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    if (shutdown_requested()) sweep.stop(i);
    append(result, sweep.settle(i));
    write_result(result, folder);
  }
  std::filesystem::remove(folder / "budget.txt");
  if (options.budget) spend(scene, sweep.methods(), result, folder, options);
  return result;
}

void run_setting(const Scene& scene, const std::filesystem::path& folder, const StudyOptions& options,
                 std::size_t setting) {
  const Sweep sweep(scene, folder, options);
  if (setting >= sweep.size())
    throw std::runtime_error(fmt::format("study: {} has {} settings", scene.file.stem().string(), sweep.size()));
  sweep.settle(setting);
}

std::size_t count_settings(const Scene& scene, const StudyOptions& options) {
  std::size_t count = 0;
  for (const auto& method : make_methods(scene, options)) count += method->points().size();
  return count;
}

}  // namespace palpate::study
