#include "tools/study/dynamic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include "common/mesh/surface.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "tools/study/ball_press.hpp"
#include "tools/study/cut_rest.hpp"
#include "tools/study/kinds.hpp"
#include "tools/study/measure.hpp"
#include "tools/study/slides.hpp"

namespace palpate::study {
namespace {

constexpr double kRestDamping = 60;  // [1/s] where a rest state is wanted, which does not depend on it
constexpr double kCourseSeconds = 0.25, kRampSeconds = 0.1;

/// What tetrahedra can be.
struct ElementChoice {
  const char* name;
  TetElement element;
  bool turns;  ///< with the tissue
};
constexpr std::array<ElementChoice, 3> kElements{{{"linear", TetElement::linear, false},
                                                  {"averaged strain", TetElement::nodal_strain, false},
                                                  {"turning", TetElement::linear, true}}};

/// A body's model on its mesh, ready to be pressed.
struct Ready {
  Archive archive;
  double offline = 0;
  std::vector<int> node;  // of the archive per surface node of the case; the case's nodes come first in any mesh
};

class Dynamic : public Method {
 public:
  Dynamic(std::shared_ptr<SolidCase> solid, MovingModel model)
      : solid_(std::move(solid)), model_(std::move(model)), name_(solid_->name(model_.name)), own_(model_.own) {}
  int body() const override { return solid_->index(); }

  std::vector<Point> points() const override {
    std::vector<Point> all;
    const palpate::Dynamic* moves = find_motion(solid_->body());
    const palpate::Dynamic motion = moves ? *moves : palpate::Dynamic{};
    const auto add = [&](const std::string& knob, const std::string& value, bool serves,
                         const std::function<void(Body&)>& change) {
      all.push_back({name_, knob, value,
                     [=, this](Scene& scene) {
                       Body& body = scene.bodies[solid_->index()];
                       model_.become(body);
                       change(body);
                     },
                     serves && own_});
    };
    add(own_ ? "scene" : "model", own_ ? "as it is" : model_.name, true, [](Body&) {});
    for (const auto& [name, element, turns] : kElements)
      if (model_.elements && (element != motion.element || turns != motion.corotational))
        add("element", name, true, [element = element, turns = turns](Body& body) {
          motion_of(body).element = element, motion_of(body).corotational = turns, motion_of(body).step = 0;
        });
    if (!own_ && solid_->quick()) return all;
    const Integrator integrator = motion.integrator == Integrator::rk4 ? Integrator::semi_implicit : Integrator::rk4;
    add("integrator", std::string(word_of(integrator)), true,
        [integrator](Body& body) { motion_of(body).integrator = integrator, motion_of(body).step = 0; });
    const Precision precision = motion.precision == Precision::float32 ? Precision::float64 : Precision::float32;
    add("precision", std::string(word_of(precision)), true,
        [precision](Body& body) { motion_of(body).precision = precision; });
    for (const int parts : {1, 2, 4, 8}) {
      if ((solid_->quick() || !own_) && parts != 1 && parts != 4) continue;
      const double step = 0.9 * bound() / parts;
      add("step", fmt::format("{:.4g} s", step), true, [step](Body& body) { motion_of(body).step = step; });
    }
    if (own_)
      for (const int layers : {-1, 1, 2, 4}) {
        if (solid_->quick() && layers != 1) continue;
        const auto part =
            std::visit([&](const auto& spec) { return grown_part(spec, solid_->mesh(), layers); }, solid_->body());
        if (part.empty() || part.size() == solid_->mesh().tetrahedra.size()) continue;
        add("dynamic share",
            fmt::format("{:.0f} %", 100.0 * static_cast<double>(part.size()) /
                                        static_cast<double>(solid_->mesh().tetrahedra.size())),
            layers > 0 && !solid_->has_two_meshes(),
            [part](Body& body) { std::visit([&](auto& spec) { set_moving_part(spec, part); }, body); });
      }
    if (model_.cut) {
      if (!solid_->quick()) all.push_back({name_, "resolution", "edges x 0.6", {}, false});
      all.push_back({name_, "cut", "a slot", {}, false});
    }
    return all;
  }

  Result evaluate(const Point& point) override {
    Scene scene = solid_->scene();
    model_.become(scene.bodies[body()]);
    if (point.apply) point.apply(scene = solid_->scene());
    Row row{solid_->scene().file.stem().string(), point.method, point.knob, point.value};
    if (point.knob == "cut") return rest_after_cut(*solid_, scene.bodies[body()], row);
    const Ready ready = point.knob == "resolution" ? prepare_finer(scene) : prepare(scene);
    row.offline_s = ready.offline;
    return press(scene, ready, row);
  }

 private:
  Ready prepare(const Scene& scene) const { return prepare(scene.bodies[body()], solid_->mesh()); }

  Ready prepare(Body body, const TetMesh& mesh) const {
    take_loads_off(*as<MovingSpec>(body));
    Ready ready;
    const auto begin = std::chrono::steady_clock::now();
    ready.archive = precompute_on(body, mesh);
    ready.offline = seconds_since(begin);
    std::vector<int> of_mesh(mesh.nodes.size(), -1);
    for (int n = 0; n < ready.archive.surface.size(); ++n) of_mesh[ready.archive.surface.node_number[n]] = n;
    for (const int n : solid_->surface().node_number) ready.node.push_back(of_mesh[n]);
    return ready;
  }

  Ready prepare_finer(Scene& scene) const {
    FinerBody finer = finer_body(scene.bodies[body()], solid_->problem(), 0.6);
    scene.bodies[body()] = finer.body;
    return prepare(finer.body, finer.mesh);
  }

  /// [s] largest stable step of the body as the scene has it.
  double bound() const {
    if (!bound_) {
      Scene scene = solid_->scene();
      model_.become(scene.bodies[body()]);
      motion_of(scene.bodies[body()]).step = 0;
      const Ready ready = prepare(scene);
      const Scene alone = solid_->press_scene(scene, 0);
      bound_ = on_first_patch(alone, ready)->rig().organ().max_step() / 0.9;
    }
    return *bound_;
  }

  std::unique_ptr<BallPress> on_first_patch(const Scene& alone, const Ready& ready) const {
    return std::make_unique<BallPress>(alone, ready.archive, solid_->presses().patches[0], solid_->presses().radius);
  }

  double tick() const { return 1 / solid_->scene().rates.haptic_hz; }

  Result press(const Scene& scene, const Ready& ready, Row row) {
    Result result;
    const Presses& presses = solid_->presses();
    PressAnswers answers;
    std::vector<double> seconds;
    bool stable = true;
    const int samples = (solid_->quick() ? 400 : 2400) / static_cast<int>(presses.patches.size());
    for (std::size_t p = 0; p < presses.patches.size(); ++p) {
      Scene alone = solid_->press_scene(scene, static_cast<int>(p));
      auto& motion = motion_of(alone.bodies[0]);
      motion.damping = std::max(kRestDamping, motion.damping);
      if (motion.step > 0) motion.step *= 0.98;  // the bound falls a little with the damping
      if (p == 0) row.memory_bytes = static_cast<double>(owner_bytes(alone, ready.archive));
      BallPress press(alone, ready.archive, presses.patches[p], presses.radius);
      answers.emplace_back();
      for (const double depth : presses.depths) {
        press.bring(depth, 50);
        PressAnswer answer;
        answer.force = press.settle(solid_->quick() ? 0.5 : 1.0);
        const auto u = press.displacement();
        for (const int n : ready.node) answer.displacement.push_back(n < 0 ? Eigen::Vector3d::Zero() : u[n]);
        stable &= std::isfinite(answer.force);
        answers.back().push_back(std::move(answer));
      }
      const auto times = press.time(50, samples);
      seconds.insert(seconds.end(), times.begin(), times.end());
    }
    if (!stable) throw std::runtime_error("the press does not stay finite");
    const StepTime time = summarise(std::move(seconds));
    row.step_us_median = 1e6 * time.median;
    row.step_us_p99 = 1e6 * time.p99;
    solid_->add_errors(row, answers, result);
    if (motion_of(scene.bodies[body()]).element == TetElement::linear)
      solid_->errors().add(row, answers, same_mesh(), "same_mesh", result);
    add_course(scene, ready, row, result);
    if (row.knob == "scene") add_slides(*solid_, scene, ready.archive, row, {}, result);
    return result;
  }

  /// The same presses of the same body without inertia, of linear elements on the mesh that it has.
  const PressAnswers& same_mesh() {
    if (!same_mesh_.empty()) return same_mesh_;
    Scene scene = solid_->scene();
    Body moving = scene.bodies[body()];
    model_.become(moving);
    auto still = as_kind<QuasiStaticSpec>(solid_->solid());
    still.offline = Offline{.element = FiniteElement::p1};
    scene.bodies[body()] = still;
    const std::vector<Archive> archives{precompute(still, solid_->mesh())};
    const Presses& presses = solid_->presses();
    for (std::size_t p = 0; p < presses.patches.size(); ++p) {
      Scene alone = solid_->press_scene(scene, static_cast<int>(p));
      BallPress press(alone, archives[0], presses.patches[p], presses.radius);
      alone.contact.rule = ContactRule::barycentric;  // shows no dent that is finer than the nodes, as moving tissue
      Deformer nodes(alone, archives);
      same_mesh_.emplace_back();
      for (const double depth : presses.depths) {
        PressAnswer& answer = same_mesh_.back().emplace_back(press.to(depth));
        answer.displacement = shown_by(nodes, *press.rig().haptic().part(0));
      }
    }
    return same_mesh_;
  }

  /// [m] of the surface's nodes under the forces on a body.
  static std::vector<Eigen::Vector3d> shown_by(Deformer& deformer, const BodyPart& pressed) {
    ContactState contacts{.run = 1};
    pressed.for_each_force([&](int, int node, const Eigen::Vector3d& f) {
      contacts.forces.push_back({.node = static_cast<std::uint32_t>(node), .force = {f.x(), f.y(), f.z()}});
    });
    deformer.take(contacts);
    deformer.deform();
    std::vector<Eigen::Vector3d> u;
    for (const Eigen::Vector3f& d : deformer.surface(0).displacement) u.push_back(d.cast<double>());
    return u;
  }

  /// Force and displacement of the first patch over time.
  std::vector<std::array<double, 2>> course(const Scene& scene, const Ready& ready) const {
    const Presses& presses = solid_->presses();
    const Scene alone = solid_->press_scene(scene, 0);
    const auto press = on_first_patch(alone, ready);
    std::array<int, 3> nodes;
    for (int v = 0; v < 3; ++v) nodes[v] = ready.node[solid_->surface().triangles[presses.patches[0].triangle][v]];
    std::vector<std::array<double, 2>> path;
    for (double t = tick(); t < kCourseSeconds; t += tick()) {
      const double force = press->step(course_depth(t, kRampSeconds, presses.radius));
      path.push_back({force, press->along(press->displacement(), nodes)});
    }
    return path;
  }

  /// Against the same model in double precision with RK4 and a sixteenth of its bound.
  void add_course(Scene scene, const Ready& ready, Row row, Result& result) {
    const auto ours = course(scene, ready);
    const Body& of = scene.bodies[body()];
    auto& motion = motion_of(scene.bodies[body()]);
    const std::string key =
        fmt::format("{} {} {} {} {}", ready.archive.tetrahedra.size(), motion.corotational, word_of(motion.element),
                    kind_of(of), ready.archive.condensed ? ready.archive.condensed->connection.size() : 0);
    if (!small_step_.contains(key)) {
      motion.integrator = Integrator::rk4;
      motion.precision = Precision::float64;
      motion.step = 0;
      const Scene alone = solid_->press_scene(scene, 0);
      motion.step = on_first_patch(alone, ready)->rig().organ().max_step() / 16;
      small_step_[key] = course(scene, ready);
    }
    row.reference = "small_step";
    study::add_course(row, ours, small_step_[key], tick(), result);
  }

  std::shared_ptr<SolidCase> solid_;
  MovingModel model_;
  std::string name_;
  bool own_;
  mutable std::optional<double> bound_;
  PressAnswers same_mesh_;
  std::map<std::string, std::vector<std::array<double, 2>>> small_step_;
};

}  // namespace

std::unique_ptr<Method> make_dynamic(std::shared_ptr<SolidCase> solid, const MovingModel& model) {
  return std::make_unique<Dynamic>(std::move(solid), model);
}

}  // namespace palpate::study
