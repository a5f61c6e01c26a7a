#include "tools/study/modal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "common/mesh/shell_file.hpp"
#include "common/mesh/surface.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "tools/study/ball_press.hpp"
#include "tools/study/kinds.hpp"
#include "tools/study/measure.hpp"

namespace palpate::study {

ShellMesh refine(const ShellMesh& mesh) {
  ShellMesh fine{mesh.nodes, {}, mesh.groups};
  std::map<std::string, std::set<int>> of_group;
  for (const auto& [name, group] : mesh.groups) of_group[name] = {group.nodes.begin(), group.nodes.end()};
  std::map<std::array<int, 2>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [found, fresh] =
        middles.emplace(std::array{std::min(a, b), std::max(a, b)}, static_cast<int>(fine.nodes.size()));
    if (!fresh) return found->second;
    fine.nodes.push_back(0.5 * (mesh.nodes[a] + mesh.nodes[b]));
    for (auto& [name, nodes] : of_group)
      if (nodes.contains(a) && nodes.contains(b)) fine.groups[name].nodes.push_back(found->second);
    return found->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const std::array<int, 3>& t : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
      fine.triangles.push_back(t);
  }
  return fine;
}

namespace {

constexpr double kWallCourseSeconds = 0.2, kWallRampSeconds = 0.04;
constexpr int kSettling = 1500;  // steps until a press rests
constexpr int kModesOfRefined = 150;

using Course = std::vector<std::array<double, 2>>;

/// Presses of one shell.
struct Pressed {
  PressAnswers answers;
  Course course;
};

class Modal : public Method {
 public:
  Modal(const Scene& scene, int body, bool quick)
      : scene_(scene),
        body_(body),
        quick_(quick),
        mesh_(load_shell_mesh(of(scene).mesh, of(scene).scale)),
        name_(scene.bodies.size() == 1 ? "modal_shell" : fmt::format("{}:modal_shell", of(scene).name)),
        as_is_(precompute(of(scene), mesh_)),
        errors_(node_areas(as_is_.surface.position, as_is_.surface.triangles),
                choose_presses(scene, as_is_.surface, quick)) {}

  int body() const override { return body_; }

  std::vector<Point> points() const override {
    std::vector<Point> all;
    const auto add = [&](const std::string& knob, const std::string& value, const std::function<void(Shell&)>& change) {
      all.push_back({name_, knob, value,
                     [b = body_, change](Scene& scene) { change(std::get<ModalShellSpec>(scene.bodies[b]).shell); },
                     true});
    };
    add("scene", "as it is", [](Shell&) {});
    const std::vector<int> counts = quick_ ? std::vector{5, 20, 50} : std::vector{5, 10, 20, 50, 100, 200};
    for (const bool residual : {true, false})
      for (const int modes : counts)
        add(residual ? "modes" : "modes without residual", std::to_string(modes),
            [modes, residual](Shell& shell) { shell.modes = modes, shell.residual = residual; });
    return all;
  }

  Result evaluate(const Point& point) override {
    Scene scene = scene_;
    point.apply(scene);
    Row row{scene_.file.stem().string(), point.method, point.knob, point.value};
    const auto begin = std::chrono::steady_clock::now();
    const Archive archive = precompute(of(scene), mesh_);
    row.offline_s = seconds_since(begin);
    std::vector<double> seconds;
    const Pressed ours = press(scene, archive, &seconds, &row.memory_bytes);
    const StepTime time = summarise(std::move(seconds));
    row.step_us_median = 1e6 * time.median;
    row.step_us_p99 = 1e6 * time.p99;
    Result result;
    errors_.add(row, ours.answers, all_modes().answers, "all_modes", result);
    row.reference = "all_modes_in_time";
    add_course(row, ours.course, all_modes().course, step(), result);
    if (!quick_) errors_.add(row, ours.answers, refined().answers, "refined_all_modes", result);
    return result;
  }

 private:
  const ModalShellSpec& of(const Scene& scene) const { return std::get<ModalShellSpec>(scene.bodies[body_]); }
  ModalShellSpec& of(Scene& scene) const { return std::get<ModalShellSpec>(scene.bodies[body_]); }
  double step() const { return 1 / scene_.rates.haptic_hz; }
  double touching() const { return errors_.presses().radius + of(scene_).shell.thickness / 2; }

  Scene press_scene(const Scene& from, const Patch& patch) const {
    Scene scene = ball_scene(from, of(from), patch, errors_.presses().radius);
    if (!from.tools.empty()) scene.tools[0].compliance = from.tools[0].compliance;
    return scene;
  }

  Pressed press(const Scene& scene, const Archive& archive, std::vector<double>* seconds, double* bytes) const {
    Pressed pressed;
    const Presses& presses = errors_.presses();
    for (const Patch& patch : presses.patches) {
      const Scene alone = press_scene(scene, patch);
      if (bytes && pressed.answers.empty()) *bytes = static_cast<double>(owner_bytes(alone, archive));
      BallPress press(alone, archive, patch, touching());
      pressed.answers.emplace_back();
      for (const double depth : presses.depths) {
        PressAnswer answer = press.to(depth, kSettling);
        answer.displacement = renumbered(answer.displacement, archive);
        pressed.answers.back().push_back(std::move(answer));
      }
      if (!seconds) continue;
      const auto times = press.time(200, (quick_ ? 600 : 2400) / static_cast<int>(presses.patches.size()));
      seconds->insert(seconds->end(), times.begin(), times.end());
    }
    pressed.course = course(scene, archive);
    return pressed;
  }

  Course course(const Scene& scene, const Archive& archive) const {
    const Patch& patch = errors_.presses().patches[0];
    BallPress press(press_scene(scene, patch), archive, patch, touching());
    Course path;
    for (double t = step(); t < kWallCourseSeconds; t += step()) {
      const double force = press.step(course_depth(t, kWallRampSeconds, errors_.presses().radius));
      const auto u = renumbered(press.displacement(), archive);
      path.push_back({force, press.along(u, as_is_.surface.triangles[patch.triangle])});
    }
    return path;
  }

  /// At the nodes of the mesh that the scene has, in the order of its archive.
  std::vector<Eigen::Vector3d> renumbered(const std::vector<Eigen::Vector3d>& u, const Archive& archive) const {
    std::vector<Eigen::Vector3d> of_mesh(archive.mesh_nodes, Eigen::Vector3d::Zero()), ours;
    for (std::size_t n = 0; n < u.size(); ++n) of_mesh[archive.surface.node_number[n]] = u[n];
    for (const int n : as_is_.surface.node_number) ours.push_back(of_mesh[n]);
    return ours;
  }

  const Pressed& all_modes() {
    if (all_modes_) return *all_modes_;
    Scene scene = scene_;
    Shell& shell = of(scene).shell;
    shell.modes = 0;
    for (const auto& fixed : as_is_.surface.fixed)
      for (const bool axis : fixed) shell.modes += !axis;
    shell.residual = true;
    return all_modes_.emplace(press(scene, precompute(of(scene), mesh_), nullptr, nullptr));
  }

  const Pressed& refined() {
    if (refined_) return *refined_;
    Scene scene = scene_;
    const ShellMesh fine = refine(mesh_);
    of(scene).shell.modes = kModesOfRefined;
    of(scene).shell.residual = true;
    NodeSelector near;
    for (int n = 0; n < static_cast<int>(fine.nodes.size()); ++n)
      for (const Patch& p : errors_.presses().patches)
        if ((fine.nodes[n] - p.point).norm() < 4 * errors_.presses().radius) {
          near.indices.push_back(n);
          break;
        }
    of(scene).touchable = near;
    return refined_.emplace(press(scene, precompute(of(scene), fine), nullptr, nullptr));
  }

  const Scene& scene_;
  int body_;
  bool quick_;
  ShellMesh mesh_;
  std::string name_;
  Archive as_is_;
  PressErrors errors_;
  std::optional<Pressed> all_modes_, refined_;
};

}  // namespace

std::unique_ptr<Method> make_modal(const Scene& scene, int body, bool quick) {
  return std::make_unique<Modal>(scene, body, quick);
}

}  // namespace palpate::study
