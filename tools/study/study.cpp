#include "tools/study/study.hpp"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <stdexcept>

#include "common/fem/dense.hpp"
#include "tools/study/budget.hpp"
#include "tools/study/catheter.hpp"
#include "tools/study/dynamic.hpp"
#include "tools/study/machine.hpp"
#include "tools/study/measure.hpp"
#include "tools/study/modal.hpp"
#include "tools/study/output_folder.hpp"
#include "tools/study/quasi_static.hpp"
#include "tools/study/store.hpp"

namespace palpate::study {
namespace {

/// A hybrid body whose two meshes meet at some nodes only: see on_one_mesh().
class JoinedAtNodes : public Method {
 public:
  JoinedAtNodes(int body, std::string name) : body_(body), name_(std::move(name)) {}
  int body() const override { return body_; }
  std::vector<Point> points() const override { return {{name_, "connection", "at some nodes", {}, false}}; }
  Result evaluate(const Point&) override {
    throw std::runtime_error(
        "the two meshes meet at some nodes only, and there is no converged solution to compare with: not assessed");
  }

 private:
  int body_;
  std::string name_;
};

void add_methods(const Scene& scene, int b, const StudyOptions& options, Methods& methods) {
  const bool quick = options.quick;
  const Body& body = scene.bodies[b];
  if (as<CatheterSpec>(body)) {
    methods.push_back(make_catheter(scene, b, quick));
    return;
  }
  if (as<ModalShellSpec>(body)) {
    methods.push_back(make_modal(scene, b, quick));
    return;
  }
  auto whole = on_one_mesh(body);
  if (!whole) {
    methods.push_back(
        std::make_unique<JoinedAtNodes>(b, scene.bodies.size() == 1 ? "hybrid" : name_of(body) + ":hybrid"));
    return;
  }
  auto solid =
      std::make_shared<SolidCase>(scene, b, *std::move(whole), quick, ReferenceCache(options.references), options.say);
  methods.push_back(make_quasi_static(solid));
  methods.push_back(make_linearity(solid));
  std::vector<std::string> models{"tensor_mass", "spring_mass"};
  if (as<HybridSpec>(body)) models.insert(models.begin(), "hybrid");
  for (const std::string& model : models) methods.push_back(make_dynamic(solid, model));
}

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
  const auto choice = choose(methods, static_cast<int>(scene.bodies.size()), result, *options.budget);
  std::string text = fmt::format("No configuration fits a step within {} here.", options.budget_text);
  if (choice) {
    std::string unit = options.budget_text;
    std::erase(unit, ' ');
    const auto file = folder / fmt::format("{}_within_{}.toml", scene.file.stem().string(), unit);
    write_choice(scene, *choice, file);
    std::string settings;
    for (const Point& p : choice->points)
      settings += fmt::format("{}{}, {} = {}", settings.empty() ? "" : "; ", p.method, p.knob, p.value);
    text = fmt::format("Within {}: {}; 99th percentile {:.3g} us, largest error {:.2g} %; written as {}.",
                       options.budget_text, settings, 1e6 * choice->p99, 100 * choice->error, file.filename().string());
  }
  std::ofstream(folder / "budget.txt") << text << '\n';
  options.say(text);
}

}  // namespace

Methods make_methods(const Scene& scene, const StudyOptions& options) {
  Methods methods;
  for (int b = 0; b < static_cast<int>(scene.bodies.size()); ++b) add_methods(scene, b, options, methods);
  return methods;
}

Result run_study(const Scene& scene, const std::filesystem::path& folder, const StudyOptions& options) {
  prepare_folder(folder, "study.csv", study_head);
  set_linear_algebra_threads(1);  // offline times then do not depend on who else computes, and nothing spins
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
